//! Where samples lie: fixed patterns, windows of an image, and the tuples of blurred ones. Host side.
//!
//! The `k × k` samples of a pixel lie one in each field of a `k × k` grid, and no two in the same of `k²` columns or rows
//! (correlated multi-jittered, Kensler 2013, without the jitter): each pixel has the same pattern, and `k` = 2 is the
//! rotated grid. Columns and rows of samples are numbered through the image, so all that kernels do with them is integers.
//!
//! Blur is interleaved (Fatahalian et al. 2009, "interleaved UVT"): there are [`TUPLES`] moments, each with a place on the
//! lens; each sample has one of them, and all samples that share one lie on a regular grid. So a blurred image is that many
//! sharp ones, each with few samples.

use crate::abi::{Frame, MAX_PATTERN_BITS, SUBPIXEL_BITS, SUBPIXELS};

/// Moments, each with a place on the lens, that a blurred image is made of.
pub const TUPLES: u32 = 64;
/// Log2 of [`TUPLES`] along one side of a square.
const TUPLE_BITS: u32 = 3;

/// Samples of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Samples {
    /// One, in the middle.
    #[default]
    One,
    /// Four.
    Four,
    /// Sixteen.
    Sixteen,
    /// Sixty-four.
    SixtyFour,
}

impl Samples {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::One, Self::Four, Self::Sixteen, Self::SixtyFour];

    /// With so many samples.
    #[must_use]
    pub fn of_count(count: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|samples| samples.count() == count)
    }

    /// Their number.
    #[must_use]
    pub const fn count(self) -> u32 {
        1 << (2 * self.bits())
    }

    /// Log2 of their columns in a pixel.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::One => 0,
            Self::Four => 1,
            Self::Sixteen => 2,
            Self::SixtyFour => 3,
        }
    }

    /// Sample number `index` of a pixel, row after row: snapped units from the pixel's left and top edge.
    #[must_use]
    pub const fn offset(self, index: u32) -> [i32; 2] {
        let bits = self.bits();
        let (column, row) = (index & ((1 << bits) - 1), index >> bits);
        // In units of half a field of the finer grid of count × count.
        let (x, y) = ((column << bits) + (1 << bits) - 1 - row, (row << bits) + column);
        let unit = SUBPIXELS >> (2 * bits);
        [x as i32 * unit + unit / 2, y as i32 * unit + unit / 2]
    }
}

/// A rectangle of pixels: left, right, top, bottom; right and bottom are one past the last.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub left: u32,
    /// One past the last column.
    pub right: u32,
    /// First row.
    pub top: u32,
    /// One past the last row.
    pub bottom: u32,
}

impl Window {
    /// All of an image.
    #[must_use]
    pub const fn whole(width: u32, height: u32) -> Self {
        Self { left: 0, right: width, top: 0, bottom: height }
    }

    /// Its columns.
    #[must_use]
    pub const fn width(self) -> u32 {
        self.right - self.left
    }

    /// Its rows.
    #[must_use]
    pub const fn height(self) -> u32 {
        self.bottom - self.top
    }

    /// Its pixels.
    #[must_use]
    pub const fn pixels(self) -> u64 {
        self.width() as u64 * self.height() as u64
    }

    /// It and so many pixels around it, as far as the image goes.
    #[must_use]
    pub fn widened(self, by: u32, width: u32, height: u32) -> Self {
        Self {
            left: self.left.saturating_sub(by),
            right: self.right.saturating_add(by).min(width),
            top: self.top.saturating_sub(by),
            bottom: self.bottom.saturating_add(by).min(height),
        }
    }

    /// Nearly square parts of at most `most` pixels, or a pixel, each; row after row.
    pub fn parts(self, most: u64) -> impl Iterator<Item = Self> + use<> {
        let side = u64::from(libm::sqrt(most as f64) as u32).max(1);
        let columns = u64::from(self.width()).div_ceil(side).max(1);
        let wide = u64::from(self.width()).div_ceil(columns).max(1);
        let rows = u64::from(self.height()).div_ceil((most / wide).max(1)).max(1);
        let cut =
            |from: u32, length: u32, part: u64, parts: u64| from + (u64::from(length) * part / parts) as u32;
        (0..rows * columns).map(move |part| {
            let (row, column) = (part / columns, part % columns);
            Self {
                left: cut(self.left, self.width(), column, columns),
                right: cut(self.left, self.width(), column + 1, columns),
                top: cut(self.top, self.height(), row, rows),
                bottom: cut(self.top, self.height(), row + 1, rows),
            }
        })
    }
}

/// Which of a frame's samples are worked on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Samples of a pixel.
    pub samples: Samples,
    /// Pixels that are sampled.
    pub window: Window,
    /// Pixels that are shown: those that all samples are there for.
    pub shown: Window,
}

impl Region {
    /// All of an image.
    #[must_use]
    pub const fn whole(width: u32, height: u32, samples: Samples) -> Self {
        let window = Window::whole(width, height);
        Self { samples, window, shown: window }
    }
}

impl Frame {
    /// The same frame with all samples of a region, and a tile size in pixels: a power of two up to 32, or 0.
    #[must_use]
    pub fn with_region(self, region: Region, tile: u32) -> Self {
        let Region { samples, window, shown } = region;
        let bits = samples.bits();
        let mut frame = Self {
            left: window.left,
            right: window.right,
            top: window.top,
            bottom: window.bottom,
            sample_left: window.left << bits,
            sample_right: window.right << bits,
            sample_top: window.top << bits,
            sample_bottom: window.bottom << bits,
            pitch_bits: SUBPIXEL_BITS - bits,
            pattern_bits: bits,
            place_first: 0,
            place_column: 1,
            place_row: window.width() << bits,
            tile_bits: if tile == 0 { 0 } else { tile.ilog2() + bits },
            shown_left: shown.left,
            shown_right: shown.right,
            shown_top: shown.top,
            shown_bottom: shown.bottom,
            ..self
        };
        let field = (1 << frame.pitch_bits) - 1;
        for index in 0..samples.count() {
            let [x, y] = samples.offset(index);
            (frame.sample_x[index as usize], frame.sample_y[index as usize]) = (x & field, y & field);
        }
        let offsets = || {
            let count = samples.count() as usize;
            frame.sample_x[..count].iter().chain(&frame.sample_y[..count]).copied()
        };
        let (least, most) = (offsets().min().unwrap_or(0), offsets().max().unwrap_or(0));
        Self { least_offset: least, most_offset: most, ..frame }
    }

    /// The same frame, which has all samples of a region, with only those that have a tuple; places stay the same.
    #[must_use]
    pub fn with_tuple(self, samples: Samples, tuple: Tuple) -> Self {
        let bits = samples.bits();
        let period = TUPLE_BITS - bits; // in pixels, log2
        let [x, y] = samples.offset(tuple.sample);
        let [across, down] = tuple.pixel;
        let along = |first: u32, end: u32, shift: u32| {
            let from = |pixel: u32| pixel.saturating_sub(shift).div_ceil(1 << period);
            (from(first), from(end))
        };
        let (sample_left, sample_right) = along(self.left, self.right, across);
        let (sample_top, sample_bottom) = along(self.top, self.bottom, down);
        let (sub_column, sub_row) = (tuple.sample & ((1 << bits) - 1), tuple.sample >> bits);
        let column = (((sample_left << period) + across).wrapping_sub(self.left) << bits) + sub_column;
        let row = (((sample_top << period) + down).wrapping_sub(self.top) << bits) + sub_row;
        let (offset_x, offset_y) = (across as i32 * SUBPIXELS + x, down as i32 * SUBPIXELS + y);
        let mut frame = Self {
            sample_left,
            sample_right,
            sample_top,
            sample_bottom,
            pitch_bits: SUBPIXEL_BITS + period,
            pattern_bits: 0,
            least_offset: offset_x.min(offset_y),
            most_offset: offset_x.max(offset_y),
            place_first: row.wrapping_mul(self.place_row).wrapping_add(column),
            place_column: 1 << TUPLE_BITS,
            place_row: self.place_row << TUPLE_BITS,
            tile_bits: self.tile_bits.saturating_sub(bits),
            ..self
        };
        (frame.sample_x[0], frame.sample_y[0]) = (offset_x, offset_y);
        frame
    }

    /// Samples that the buffers of samples must hold.
    #[must_use]
    pub const fn sample_count(&self) -> u64 {
        let window = Window { left: self.left, right: self.right, top: self.top, bottom: self.bottom };
        window.pixels() << (2 * self.pattern_bits)
    }

    /// Pixels that are shown.
    #[must_use]
    pub const fn shown_count(&self) -> u64 {
        let (left, right) = (self.shown_left, self.shown_right);
        Window { left, right, top: self.shown_top, bottom: self.shown_bottom }.pixels()
    }
}

/// A moment and a place on the lens, and the samples that have them: one of some pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuple {
    /// When, from 0, as the shutter opens, to 1, as it closes.
    pub time: f64,
    /// Where on a lens of radius 1.
    pub lens: [f64; 2],
    /// Which sample of the pixel.
    pub sample: u32,
    /// Column and row of the pixel, modulo the period of the tuples.
    pub pixel: [u32; 2],
}

/// All tuples. The samples of a pixel have moments, and places on the lens, that are spread evenly; so have the pixels of a
/// period for each sample.
pub fn tuples(samples: Samples) -> impl Iterator<Item = Tuple> {
    (0..TUPLES).map(move |number| {
        let count = samples.count();
        let period = TUPLE_BITS - samples.bits();
        let (sample, pixel) = (number % count, number / count);
        let at = [pixel & ((1 << period) - 1), pixel >> period];
        // Neighbours should differ much, so bits of columns and rows take turns, from the coarsest on. The samples of a
        // pixel are the strata of time, and any so many successive points of the sequence are strata of the lens.
        let own = reversed(mixed(sample, samples.bits()), 2 * samples.bits());
        let shift = reversed(mixed(pixel, period), 2 * period);
        let time = (f64::from(own * (TUPLES / count) + shift) + 0.5) / f64::from(TUPLES);
        let square =
            sequence(own + count * shift).map(|k| (f64::from(k) + 0.5) / f64::from(TUPLES) * 2.0 - 1.0);
        Tuple { time, lens: on_disk(square), sample, pixel: at }
    })
}

/// Bits of column and row of a number in a square of `1 << bits` columns, taking turns.
fn mixed(index: u32, bits: u32) -> u32 {
    let (column, row) = (index & ((1 << bits) - 1), index >> bits);
    (0..bits).fold(0, |out, bit| {
        out | ((column ^ row) >> bit & 1) << (2 * bit + 1) | (row >> bit & 1) << (2 * bit)
    })
}

/// The lowest `bits` bits in reverse order.
const fn reversed(index: u32, bits: u32) -> u32 {
    if bits == 0 { 0 } else { index.reverse_bits() >> (u32::BITS - bits) }
}

/// Point `index` of a (0, 2)-sequence in base 2 (Sobol 1967), in units of 1 / [`TUPLES`].
fn sequence(index: u32) -> [u32; 2] {
    let (mut direction, mut second) = (TUPLES / 2, 0);
    for bit in 0..2 * TUPLE_BITS {
        if index >> bit & 1 == 1 {
            second ^= direction;
        }
        direction ^= direction >> 1;
    }
    [reversed(index, 2 * TUPLE_BITS), second]
}

/// A square onto a disk, areas kept (Shirley & Chiu 1997).
fn on_disk([x, y]: [f64; 2]) -> [f64; 2] {
    if x == 0.0 && y == 0.0 {
        return [0.0; 2];
    }
    let quarter = core::f64::consts::FRAC_PI_4;
    let (radius, angle) =
        if x * x > y * y { (x, quarter * (y / x)) } else { (y, 2.0 * quarter - quarter * (x / y)) };
    let (sine, cosine) = libm::sincos(angle);
    [radius * cosine, radius * sine]
}

const _: () = assert!(MAX_PATTERN_BITS == TUPLE_BITS);
