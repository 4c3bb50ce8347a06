// Mirrors core/src/kernel/tess_evaluate.rs (built_in): a vertex of patch `index` by its coordinates. A caller's own evaluation
// takes the place of this file.

fn evaluated(index: u32, coordinates: vec3<u32>) -> TessVertex {
    return evaluate(index, coordinates);
}
