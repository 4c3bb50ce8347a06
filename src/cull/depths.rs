//! What has been drawn so far, as depths: of each sample, and of squares of 2 × 2, 4 × 4 and so on the farthest one (Greene,
//! Kass & Miller 1993, "Hierarchical Z-buffer visibility").

use micropoly_core::abi::{FLAG_LAYERS, Frame, OPAQUE_DEPTH, Sample};
use micropoly_core::backend::Device;
use micropoly_core::cull::{Outline, depths_of_row};
use micropoly_core::render::Buffers;
use rayon::prelude::*;

/// Rows that a thread works on at a time.
const ROWS: usize = 16;

/// One level.
#[derive(Debug, Default)]
struct Level {
    columns: usize,
    depths: Vec<u32>,
}

impl Level {
    fn at(&self, column: usize, row: usize) -> u32 {
        self.depths[row * self.columns + column]
    }

    fn rows(&self) -> usize {
        self.depths.len() / self.columns.max(1)
    }

    /// Makes room; `fill` fills row after row.
    fn set(&mut self, columns: usize, rows: usize, fill: impl Fn(usize, &mut [u32]) + Sync) {
        self.columns = columns;
        self.depths.resize(columns * rows, 0);
        let rows = self.depths.par_chunks_mut(columns.max(1)).with_min_len(ROWS);
        rows.enumerate().for_each(|(row, out)| fill(row, out));
    }

    /// Each of its squares becomes the farthest of four of another level.
    fn set_above(&mut self, below: &Self) {
        self.set(below.columns.div_ceil(2), below.rows().div_ceil(2), |row, out| {
            let both = [2 * row, (2 * row + 1).min(below.rows() - 1)];
            let [a, b] = both.map(|row| &below.depths[row * below.columns..][..below.columns]);
            for (out, (a, b)) in out.iter_mut().zip(a.chunks(2).zip(b.chunks(2))) {
                *out = a.iter().chain(b).copied().min().unwrap_or(0);
            }
        });
    }
}

/// All levels; none if nothing has been drawn yet.
#[derive(Debug, Default)]
pub(super) struct Depths {
    levels: Vec<Level>,
    /// What was read last, to be written over.
    samples: Vec<Sample>,
    behind: Vec<Sample>,
}

impl Depths {
    /// Is nothing known yet?
    pub(super) const fn is_empty(&self) -> bool {
        self.levels.is_empty()
    }

    /// Reads the depths of the frame's samples.
    pub(super) fn read<D: Device>(
        &mut self,
        device: &mut D,
        buffers: &Buffers<D::Buffer>,
        frame: &Frame,
    ) -> Result<(), D::Error> {
        let count = frame.place_end() as usize;
        self.samples.resize(count, Sample::default());
        device.read(&buffers.samples, 0, &mut self.samples)?;
        if frame.flags & FLAG_LAYERS != 0 {
            self.behind.resize(count, Sample::default());
            device.read(&buffers.behind, 0, &mut self.behind)?;
        }
        self.build(frame);
        Ok(())
    }

    fn build(&mut self, frame: &Frame) {
        let Self { levels, samples, behind } = self;
        let columns = frame.sample_right.saturating_sub(frame.sample_left) as usize;
        let rows = frame.sample_bottom.saturating_sub(frame.sample_top) as usize;
        let count = usize::BITS - columns.max(rows).saturating_sub(1).leading_zeros() + 1;
        levels.resize_with(count as usize, Level::default);
        levels[0].set(columns, rows, |row, out| {
            for (out, depth) in out.iter_mut().zip(depths_of_row(frame, samples, row as u32)) {
                *out = depth;
            }
            if frame.flags & FLAG_LAYERS == 0 {
                return;
            }
            for (out, depth) in out.iter_mut().zip(depths_of_row(frame, behind, row as u32)) {
                if depth == OPAQUE_DEPTH {
                    *out = u32::MAX; // nothing is seen there any more
                }
            }
        });
        for level in 1..levels.len() {
            let (below, above) = levels.split_at_mut(level);
            above[0].set_above(&below[level - 1]);
        }
    }

    /// Is everything that has this outline behind what is there, at every sample that it can touch?
    pub(super) fn hide(&self, outline: &Outline) -> bool {
        let Outline { columns, rows, nearest } = *outline;
        let wide = (columns[1] - columns[0]).max(rows[1] - rows[0]);
        // The level whose squares are no smaller.
        let level = (u32::BITS - (wide - 1).leading_zeros()) as usize;
        let all = [columns, rows].map(|range| range.map(|at| at as usize));
        !self.is_empty() && self.are_behind(level.min(self.levels.len() - 1), all, nearest)
    }

    /// Are these columns and rows of samples, as squares of a level show them, all nearer?
    fn are_behind(&self, level: usize, [columns, rows]: [[usize; 2]; 2], nearest: u32) -> bool {
        let squares = |[first, end]: [usize; 2]| first >> level..((end - 1) >> level) + 1;
        let within = |[first, end]: [usize; 2], square: usize| {
            [first.max(square << level), end.min((square + 1) << level)]
        };
        squares(rows).all(|row| {
            squares(columns).all(|column| {
                self.levels[level].at(column, row) > nearest
                    || (level > 0
                        && self.are_behind(level - 1, [within(columns, column), within(rows, row)], nearest))
            })
        })
    }
}
