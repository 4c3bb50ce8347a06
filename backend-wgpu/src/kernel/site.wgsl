// Mirrors core/src/kernel/triangle.rs (site, samples_between): where samples lie, in columns and rows, and where each of
// them has its place in the buffers.

fn imin(a: i32, b: i32) -> i32 {
    return select(b, a, a < b);
}

fn imax(a: i32, b: i32) -> i32 {
    return select(b, a, a > b);
}

// Where the sample in this column and row is, snapped.
fn site(column: i32, row: i32) -> vec2<i32> {
    let mask = (1 << frame.pattern_bits) - 1;
    let index = ((row & mask) << frame.pattern_bits) | (column & mask);
    return vec2<i32>(
        (column << frame.pitch_bits) + frame.sample_x[index],
        (row << frame.pitch_bits) + frame.sample_y[index],
    );
}

// First column (or row) of samples that need not be before `low`, and one past the last that need not be after `high`.
fn samples_between(low: i32, high: i32) -> vec2<i32> {
    let field = (1 << frame.pitch_bits) - 1;
    return vec2<i32>(
        (low - frame.most_offset + field) >> frame.pitch_bits,
        ((high - frame.least_offset) >> frame.pitch_bits) + 1,
    );
}

// What two ranges have in common.
fn overlap(a: vec2<i32>, b: vec2<i32>) -> vec2<i32> {
    return vec2<i32>(imax(a.x, b.x), imin(a.y, b.y));
}

// The frame's columns of samples, and its rows.
fn frame_columns() -> vec2<i32> {
    return vec2<i32>(i32(frame.sample_left), i32(frame.sample_right));
}

fn frame_rows() -> vec2<i32> {
    return vec2<i32>(i32(frame.sample_top), i32(frame.sample_bottom));
}

// Place of a sample in the buffers.
fn place_of(column: i32, row: i32) -> u32 {
    return frame.place_first
        + (u32(row) - frame.sample_top) * frame.place_row
        + (u32(column) - frame.sample_left) * frame.place_column;
}
