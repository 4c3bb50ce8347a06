//! A sub-surface: a patch and a dyadic parameter range, all integers.
//!
//! Ranges come from halving only, so their ends, their middles and every vertex of a grid on them are
//! multiples of 2⁻²⁴: exact as integers and exact in `f32` (Reyes split, Cook, Carpenter & Catmull 1987).

use crate::abi::{Draw, PARAM_ONE, RATE_U_SHIFT, RATE_V_SHIFT, Surface, Verdict};

const LEVEL_MASK: u32 = 31;
const LEVELS_MASK: u32 = LEVEL_MASK | LEVEL_MASK << V_LEVEL_SHIFT;
const V_LEVEL_SHIFT: u32 = 5;

impl Surface {
    /// The whole of a patch.
    #[must_use]
    pub const fn root(patch_id: u32) -> Self {
        Self { patch_id, u: 0, v: 0, shape: 0, borders: [0; 4] }
    }

    /// How often `u` was halved.
    #[inline(always)]
    #[must_use]
    pub const fn u_level(self) -> u32 {
        self.shape & LEVEL_MASK
    }

    /// How often `v` was halved.
    #[inline(always)]
    #[must_use]
    pub const fn v_level(self) -> u32 {
        (self.shape >> V_LEVEL_SHIFT) & LEVEL_MASK
    }

    /// Level: how often the patch was split to get here.
    #[inline(always)]
    #[must_use]
    pub const fn level(self) -> u32 {
        self.u_level() + self.v_level()
    }

    /// Width of the range of `u` in units of 2⁻²⁴.
    #[inline(always)]
    #[must_use]
    pub const fn u_size(self) -> u32 {
        PARAM_ONE >> self.u_level()
    }

    /// Width of the range of `v` in units of 2⁻²⁴.
    #[inline(always)]
    #[must_use]
    pub const fn v_size(self) -> u32 {
        PARAM_ONE >> self.v_level()
    }

    /// The two halves of the range of `u`, lower first, with borders that are not theirs yet.
    #[inline(always)]
    pub(crate) const fn halves_u(self) -> [Self; 2] {
        let shape = self.shape + 1;
        [Self { shape, ..self }, Self { shape, u: self.u + self.u_size() / 2, ..self }]
    }

    /// The two halves of the range of `v`, lower first, with borders that are not theirs yet.
    #[inline(always)]
    pub(crate) const fn halves_v(self) -> [Self; 2] {
        let shape = self.shape + (1 << V_LEVEL_SHIFT);
        [Self { shape, ..self }, Self { shape, v: self.v + self.v_size() / 2, ..self }]
    }
}

impl Draw {
    /// The surface to be drawn and the pixels `verdict` allows it.
    #[inline(always)]
    #[must_use]
    pub const fn new(surface: Surface, verdict: Verdict) -> Self {
        let Surface { patch_id, u, v, shape, borders } = surface.divided(verdict);
        let [rate_u, rate_v] = verdict.rates();
        let shape = shape | rate_u << RATE_U_SHIFT | rate_v << RATE_V_SHIFT;
        Self { patch_id, u, v, shape, borders, columns: verdict.columns, rows: verdict.rows }
    }

    /// The surface itself.
    #[inline(always)]
    #[must_use]
    pub const fn surface(self) -> Surface {
        let Self { patch_id, u, v, shape, borders, .. } = self;
        Surface { patch_id, u, v, shape: shape & LEVELS_MASK, borders }
    }

    /// First row of pixels it can touch, and one past the last.
    #[inline(always)]
    #[must_use]
    pub const fn row_range(self) -> (u32, u32) {
        (self.rows & 0xffff, self.rows >> 16)
    }
}
