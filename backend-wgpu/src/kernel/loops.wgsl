// No mirror in core: did the driver end a loop early?

// Mesa's llvmpipe silently ends all loops once a shader has gone through 65535 iterations in all; then this
// one, too, ends early. ZERO keeps compilers from counting it out.
fn loops_were_cut() -> bool {
    var rounds = 0u;
    while rounds < 4u + ZERO {
        rounds += 1u;
    }
    return rounds != 4u;
}
