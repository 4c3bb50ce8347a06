//! Topology: from the corners of faces to what is next to what.

use rayon::prelude::*;

use super::error::CageError;
use super::level::{Level, NONE};

/// Fills in which corners are at each vertex and which half-edges run against each other.
///
/// # Errors
/// If an edge has more than two faces, or they do not run along it in opposite directions.
pub(super) fn connect(level: &mut Level) -> Result<(), CageError> {
    collect_fans(level);
    let found: &Level = level;
    let twins: Result<Vec<u32>, CageError> =
        (0..found.corners.len()).into_par_iter().with_min_len(4096).map(|h| opposite(found, h)).collect();
    match twins {
        Ok(twins) => {
            level.twins = twins;
            Ok(())
        }
        // Which of several errors comes first depends on timing: look for the first one.
        Err(error) => Err((0..level.corners.len()).find_map(|h| opposite(level, h).err()).unwrap_or(error)),
    }
}

/// Corners, sorted by their vertices.
fn collect_fans(level: &mut Level) {
    let mut starts = vec![0; level.points.len() + 1];
    for &vertex in &level.corners {
        starts[vertex as usize + 1] += 1;
    }
    for vertex in 1..starts.len() {
        starts[vertex] += starts[vertex - 1];
    }
    let mut places = starts.clone();
    level.fans = vec![0; level.corners.len()];
    for (corner, &vertex) in level.corners.iter().enumerate() {
        let place = &mut places[vertex as usize];
        level.fans[*place as usize] = corner as u32;
        *place += 1;
    }
    level.fan_starts = starts;
}

/// The half-edge against this one, looked for where fewer faces meet.
fn opposite(level: &Level, half_edge: usize) -> Result<u32, CageError> {
    let (from, to) = (level.vertex(half_edge), level.end(half_edge));
    let is_at_end = level.fan(to).len() <= level.fan(from).len();
    let mut twin = NONE;
    for &corner in level.fan(if is_at_end { to } else { from }) {
        let leaving = corner as usize;
        let arriving = level.previous(leaving);
        let (against, along) = if is_at_end { (leaving, arriving) } else { (arriving, leaving) };
        if along != half_edge && level.vertex(along) == from && level.end(along) == to {
            return Err(crossed(level, half_edge));
        }
        if level.vertex(against) == to && level.end(against) == from {
            twin = against as u32;
        }
    }
    Ok(twin)
}

/// Why two half-edges run from the same vertex to the same vertex.
fn crossed(level: &Level, half_edge: usize) -> CageError {
    let (from, to) = (level.vertex(half_edge), level.end(half_edge));
    let runs = |a, b| level.fan(a).iter().filter(|&&corner| level.end(corner as usize) == b).count();
    let (face, vertices) = (level.face_of(half_edge) as u32, [from as u32, to as u32]);
    if runs(from, to) + runs(to, from) > 2 {
        CageError::CrowdedEdge { face, vertices }
    } else {
        CageError::Winding { face, vertices }
    }
}
