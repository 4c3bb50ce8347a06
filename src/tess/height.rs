//! Height maps, from pictures.

use std::path::Path;

use crate::error::{Error, Result};
use crate::picture::Picture;

/// Heights, row by row from v = 0 upwards. The map repeats itself beyond 0 to 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeightMap {
    /// Columns.
    pub columns: u32,
    /// Rows.
    pub rows: u32,
    /// Heights; those of PNG files run from 0 (black) to 1 (white).
    pub heights: Vec<f32>,
}

impl HeightMap {
    /// Reads a picture (.png or .exr): grey values, or the mean of red, green and blue.
    ///
    /// # Errors
    /// [`Error::Read`] or [`Error::Content`].
    pub fn load(path: &Path) -> Result<Self> {
        let picture = Picture::load(path)?;
        let wrong = |why: &str| Error::content(path, why, "give a grey or coloured picture of finite values");
        let channel = |name: &str| picture.channels.get(name).map(Vec::as_slice);
        let values: Vec<f64> = match (channel("Y"), channel("R"), channel("G"), channel("B")) {
            (Some(grey), ..) => grey.to_vec(),
            (None, Some(red), Some(green), Some(blue)) => {
                red.iter().zip(green).zip(blue).map(|((r, g), b)| (r + g + b) / 3.0).collect()
            }
            _ => return Err(wrong("it has neither a channel Y nor R, G and B, so that it has no heights")),
        };
        let is_possible = |value: &f64| value.abs() <= f64::from(MOST_HEIGHT);
        if values.is_empty() || !values.iter().all(is_possible) {
            return Err(wrong("one of its heights is no number, or too large"));
        }
        let (Ok(columns), Ok(rows)) = (u32::try_from(picture.width), u32::try_from(picture.height)) else {
            return Err(wrong("it is too large"));
        };
        // Pictures begin at the top.
        let heights = values.chunks(picture.width).rev().flatten().map(|value| *value as f32).collect();
        Ok(Self { columns, rows, heights })
    }
}

/// Largest height, before it is scaled.
const MOST_HEIGHT: f32 = 1.0e6;
