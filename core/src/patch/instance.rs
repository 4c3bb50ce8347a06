//! Instances: objects that have the same patches. Patches are numbered object by object, records are not repeated.

use crate::abi::{FLAG_INSTANCES, Frame, Object, Patch};

/// What a patch's number stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instance {
    /// Its record.
    pub record: u32,
    /// Its object.
    pub object: u32,
}

/// Record and object of a patch: the object is the last that does not begin after it.
#[inline(always)]
#[must_use]
pub fn instance(frame: &Frame, objects: &[Object], patches: &[Patch], patch_id: u32) -> Instance {
    if frame.flags & FLAG_INSTANCES == 0 {
        return Instance { record: patch_id, object: patches[patch_id as usize].object };
    }
    let (mut low, mut high) = (0, frame.object_count);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if objects[middle as usize].first_patch <= patch_id {
            low = middle;
        } else {
            high = middle;
        }
    }
    let object = &objects[low as usize];
    Instance { record: object.first_record + patch_id - object.first_patch, object: low }
}
