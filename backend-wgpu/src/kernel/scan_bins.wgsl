// No mirror in core: from the number of grids in each bin to where its part of the list starts; one group.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read_write> bins: array<u32>;

const RUNS: u32 = 256u;

// Grids in each run of bins.
var<workgroup> totals: array<u32, RUNS>;

@compute @workgroup_size(RUNS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let run = (bin_count() + RUNS - 1u) / RUNS;
    let first = lane * run;
    let end = select(bin_count(), first + run, first + run < bin_count());
    var total = 0u;
    for (var bin = first; bin < end; bin++) {
        total += bins[BINS + bin];
    }
    totals[lane] = total;
    workgroupBarrier();
    var start = 0u;
    for (var before = 0u; before < lane; before++) {
        start += totals[before];
    }
    for (var bin = first; bin < end; bin++) {
        let count = bins[BINS + bin];
        bins[BINS + bin] = start;
        start += count;
    }
}
