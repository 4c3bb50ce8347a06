//! Shapes become the records that devices read. A shape that several objects have is there once.

use std::sync::Arc;

use micropoly_core::abi::{KIND_HALF_SHIFT, KIND_RATIONAL, Object, Patch};
use micropoly_core::adjacency::{find_owners, room_needed};
use micropoly_core::patch::owner::owned_by_half;

use crate::scene::SceneObject;
use crate::shape::{RationalPatch, Shape};

/// Which shapes a scene has, and which object has which.
pub(crate) struct Shapes<'a> {
    /// Each once, in the order of the objects, with the first object that has it and its first record.
    distinct: Vec<(&'a Shape, u32, u32)>,
    /// An object each: which of them it has.
    of: Vec<usize>,
}

impl<'a> Shapes<'a> {
    pub(crate) fn of(objects: &'a [SceneObject]) -> Self {
        let mut sorted: Vec<usize> = (0..objects.len()).collect();
        let address = |index: &usize| Arc::as_ptr(&objects[*index].shape);
        sorted.sort_by_key(|index| (address(index), *index));
        let mut first = vec![0; objects.len()];
        for group in sorted.chunk_by(|a, b| address(a) == address(b)) {
            group.iter().for_each(|index| first[*index] = group[0]);
        }
        let (mut distinct, mut of, mut record) = (Vec::new(), vec![0; objects.len()], 0);
        for (index, object) in objects.iter().enumerate() {
            if first[index] == index {
                of[index] = distinct.len();
                distinct.push((&*object.shape, index as u32, record as u32));
                record += object.shape.patch_count();
            } else {
                of[index] = of[first[index]];
            }
        }
        Self { distinct, of }
    }

    /// Has any shape more than one object?
    pub(crate) fn are_shared(&self) -> bool {
        self.distinct.len() < self.of.len()
    }

    /// Number of all records.
    pub(crate) fn record_count(&self) -> usize {
        self.distinct.iter().map(|(shape, _, _)| shape.patch_count() + shape.extra_count()).sum()
    }

    /// Tells each object where its patches are.
    pub(crate) fn number(&self, objects: &mut [Object]) {
        let mut patch = 0;
        for (object, &shape) in objects.iter_mut().zip(&self.of) {
            let (shape, _, record) = self.distinct[shape];
            (object.first_patch, object.first_record) = (patch, record);
            patch += shape.patch_count() as u32;
        }
    }

    /// All records: patches, shape after shape, and behind them what some kinds need besides.
    pub(crate) fn records(&self, with_owners: bool) -> Vec<Patch> {
        let count = self.distinct.iter().map(|(shape, _, _)| shape.patch_count()).sum::<usize>();
        let (mut patches, mut extra) = (Vec::with_capacity(self.record_count()), Vec::new());
        for (shape, object, first) in &self.distinct {
            patches.extend(shape.bezier.iter().map(|patch| record(patch.points, *object, 0)));
            for patch in &shape.rational {
                let weights = (count + extra.len()) as u32;
                let own = record(patch.points, *object, weights);
                patches.push(Patch { kind: KIND_RATIONAL, ..own });
                extra.push(weights_of(patch, *object));
            }
            for patch in &shape.gregory {
                patches.push(record(patch.net(), *object, (count + extra.len()) as u32));
                extra.push(patch.faces(*object));
            }
            join(shape, &mut patches[*first as usize..], *first);
        }
        patches.append(&mut extra);
        if with_owners {
            let mut room = vec![0; room_needed(&patches)];
            find_owners(&mut patches, &mut room);
        }
        patches
    }
}

/// Puts down which sides are halves of others.
fn join(shape: &Shape, patches: &mut [Patch], first: u32) {
    for half in &shape.halves {
        let (side, coarse_side) = (half.fine_side, half.coarse_side);
        let fine = &mut patches[half.fine as usize];
        fine.kind |= 1 << side << KIND_HALF_SHIFT;
        fine.owners[usize::from(side)] =
            owned_by_half(first + half.coarse, coarse_side.into(), half.is_reversed, half.is_second);
        patches[half.coarse as usize].kind |= 1 << coarse_side;
    }
}

fn record(points: [[f32; 3]; 16], object: u32, faces: u32) -> Patch {
    let axis = |k: usize| points.map(|point| point[k]);
    Patch { x: axis(0), y: axis(1), z: axis(2), object, faces, ..Patch::default() }
}

fn weights_of(patch: &RationalPatch, object: u32) -> Patch {
    Patch { x: patch.weights, object, ..Patch::default() }
}
