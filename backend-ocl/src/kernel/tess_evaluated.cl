// Mirrors `built_in` of core/src/kernel/tess_evaluate.rs: built-in evaluation. A caller's own `evaluated` takes the place
// of this file.

static TessVertex evaluated(__constant TessFrame *frame, __global const TessPatch *patches,
                            __global const float *heights, uint index, uint3 coordinates) {
    const TessSurface surface = new_tess_surface(frame, patches + index);
    return evaluate(frame, patches + index, &surface, heights, coordinates);
}
