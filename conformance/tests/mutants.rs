//! Which operators are changed, and which mutants a sample has.

use micropoly_conformance::mutation::{mutants, sample};

#[test]
fn every_operator_is_changed_once() {
    let source = "fn f(a: u32) -> u32 { // a + b\n    return max(add(a, a) + 1u, fold_max(b));\n}\n";
    let changed: Vec<String> = mutants(source)
        .into_iter()
        .map(|mutant| mutant.source.lines().nth(1).unwrap_or("").to_owned())
        .collect();
    assert_eq!(
        changed,
        [
            "    return min(add(a, a) + 1u, fold_max(b));",
            "    return max(sub(a, a) + 1u, fold_max(b));",
            "    return max(add(a, a) - 1u, fold_max(b));",
            "    return max(add(a, a) + 1u, fold_min(b));",
        ]
    );
}

#[test]
fn comparisons_are_not_taken_for_negations() {
    let changes: Vec<_> = mutants("if a != b && !c {\n").into_iter().map(|mutant| mutant.change).collect();
    assert_eq!(changes, [(" != ", " == "), (" && ", " || "), ("!", " ")]);
}

#[test]
fn a_sample_is_spread_and_always_the_same() {
    for (count, most) in [(0, 3), (2, 3), (3, 3), (10, 3), (100, 7), (5, usize::MAX)] {
        let all: Vec<usize> = (0..count).collect();
        let chosen = sample(all.clone(), most);
        assert_eq!(chosen.len(), count.min(most), "{most} of {count}");
        assert_eq!(chosen, sample(all, most));
        let widest = chosen.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap_or(0);
        assert!(widest <= count / most.min(count).max(1) + 1, "{chosen:?}");
    }
}
