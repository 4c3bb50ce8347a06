// Mirrors `control` of core/src/kernel/tess_control.rs: built-in levels. A caller's own `levels_of` takes the place of
// this file.

static TessLevels levels_of(__constant TessFrame *frame, __global const TessPatch *patches,
                            __global const TessLevels *levels, uint index) {
    return frame->control == TESS_GIVEN ? levels[index] : levels_by_frame(frame, patches + index);
}
