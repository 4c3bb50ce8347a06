//! The rest of a tree once few parts are left: the sides of all of their corners are found at once, then bits are counted.

#![allow(unsafe_code)] // only what `multiversion` generates: the same functions for several instruction sets

use micropoly_core::accel::bsp::lattice::Point;
use micropoly_core::accel::bsp::plane::{Plane, Rough};
use micropoly_core::accel::bsp::polygon::{Corner, Cut, Cutter, Knife, Origin, side, whole};
use micropoly_core::accel::bsp::rank::BspNode;
use micropoly_core::accel::bsp::table::{Division, FEW, Planes, SLOTS, Set, Sides, Table};
use multiversion::multiversion;

use super::clip::uncut;
use super::cut::Part;
use super::shared::{CORNERS, Shared};
use super::tree::{Gardener, Waiting};

/// Where a plane cuts as many parts, they cut each other much: then they are first cut to the size of the cell, which takes
/// longer, so that what is beyond it is not cut again and again.
const CLIPPED: u32 = 3;

/// Parts that are looked at together, and what is known about them.
pub(super) struct Few {
    table: Table,
    parts: [Part; SLOTS],
    /// The plane of each part's triangle: the first slots are those of their own planes. And the triangles of all planes.
    planes: [u8; SLOTS],
    cutters: [u32; FEW],
    /// Slots without a part, behind those.
    free: Set,
    /// Corners of whole parts, their sides, and which are those of each plane's triangle.
    shared: Shared,
    shared_sides: [Sides; CORNERS],
    corners: [[u8; 3]; FEW],
    /// Sides of the corners that the parts have in the list of all.
    sides: Vec<Sides>,
    /// The part that is being cut, its corners' sides of the plane that cuts it, and what is before and behind that.
    piece: Ring,
    signs: Vec<i8>,
    halves: [Ring; 2],
    /// Nodes that are not yet divided, and whose back they are.
    tasks: Vec<(Set, Option<usize>)>,
}

/// Corners of a part, and their sides.
#[derive(Default)]
struct Ring {
    corners: Vec<Corner>,
    sides: Vec<Sides>,
}

impl Default for Few {
    fn default() -> Self {
        let (sides, piece, signs, halves, tasks) = Default::default();
        let none = Part { triangle: 0, first: 0, count: 0, slabs: [Cut::NONE; 3] };
        Self {
            table: Table::default(),
            parts: [none; SLOTS],
            planes: [0; SLOTS],
            cutters: [0; FEW],
            free: 0,
            shared: Shared::default(),
            shared_sides: [Sides::default(); CORNERS],
            corners: [[0; 3]; FEW],
            sides,
            piece,
            signs,
            halves,
            tasks,
        }
    }
}

/// On which sides of all planes some corners of triangles are, exactly or but for a tolerance.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))]
fn note_shared(planes: &Planes, points: &[Point], is_exact: bool, sides: &mut [Sides]) {
    for (point, sides) in points.iter().zip(sides) {
        *sides = if is_exact {
            planes.sides_of_vertex(point)
        } else {
            planes.far_sides([f64::from(point[0]), f64::from(point[1]), f64::from(point[2])])
        };
    }
}

/// Notes on which sides of all planes the corners of some parts are, each in the slot of its number.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))]
fn note(
    table: &mut Table,
    parts: &[Part],
    triangles: &[[Point; 3]],
    corners: &[Corner],
    is_exact: bool,
    sides: &mut [Sides],
    wholes: &[Sides],
) {
    for (slot, part) in parts.iter().enumerate() {
        let asked = table.planes.all() & !(1 << slot);
        if part.is_whole() {
            table.put(slot, wholes[slot].only(asked));
            continue;
        }
        let (triangle, piece) = (&triangles[part.triangle as usize], part.corners(corners));
        let mut all = Sides::default();
        for k in 0..piece.len() {
            let found = if is_exact {
                table.planes.sides(triangle, piece, k, asked)
            } else {
                table.planes.far_sides(piece[k].at)
            };
            sides[part.first as usize + k] = found;
            all = all.and(found);
        }
        table.put(slot, all.only(asked));
    }
}

/// As core's `sides_of_made`, or `far_sides` if it need not be exact.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))]
fn sides_of_made(
    planes: &Planes,
    triangle: &[Point; 3],
    at: [f64; 3],
    lines: [[i64; 3]; 2],
    asked: u64,
    is_exact: bool,
) -> Sides {
    if is_exact { planes.sides_of_made(triangle, at, lines, asked) } else { planes.far_sides(at) }
}

/// As core's `put`.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512vl+avx512dq", "x86_64+avx2"))]
fn put(table: &mut Table, slot: usize, sides: Sides) {
    table.put(slot, sides);
}

/// As core's `best`.
#[multiversion(targets("x86_64+avx2+popcnt+bmi1+bmi2+lzcnt"))]
fn best(table: &Table, set: Set, planes: u64) -> usize {
    table.best(set, planes)
}

/// The slots of a set.
fn slots(mut set: Set) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let slot = set.trailing_zeros();
        set &= set.checked_sub(1)?;
        Some(slot as usize)
    })
}

impl Few {
    /// The planes of some parts.
    fn planes_of(&self, set: Set) -> u64 {
        slots(set >> FEW).fold(set as u64, |planes, slot| planes | 1 << self.planes[FEW + slot])
    }

    /// Parts, lower triangles first.
    fn sorted(&self, set: Set) -> Vec<Part> {
        let mut parts: Vec<Part> = slots(set).map(|slot| self.parts[slot]).collect();
        parts.sort_by_key(|part| part.triangle);
        parts
    }

    /// Takes out the corners of a part that will be cut, and their sides.
    fn open(&mut self, slot: usize, triangle: &[Point; 3], corners: &[Corner]) {
        let part = self.parts[slot];
        let Ring { corners: own, sides } = &mut self.piece;
        own.clear();
        sides.clear();
        if part.is_whole() {
            own.extend_from_slice(&whole(triangle));
            sides.extend(self.corners[slot].iter().map(|number| self.shared_sides[usize::from(*number)]));
        } else {
            own.extend_from_slice(part.corners(corners));
            sides.extend_from_slice(&self.sides[part.first as usize..][..part.count as usize]);
        }
    }

    /// Notes the corners' sides of the plane that cuts them.
    fn sign(&mut self, triangle: &[Point; 3], plane: usize, exact: &Plane, is_exact: bool) {
        if is_exact {
            self.signs.clear();
            self.signs.extend(self.piece.sides.iter().map(|sides| sides.of(plane)));
        } else {
            self.sign_anew(triangle, exact);
        }
    }

    /// The same of a plane that the table need not have.
    fn sign_anew(&mut self, triangle: &[Point; 3], plane: &Plane) {
        let Self { piece: Ring { corners, .. }, signs, .. } = self;
        let rough = Rough::of(plane);
        signs.clear();
        signs.extend((0..corners.len()).map(|k| side(triangle, corners, k, plane, &rough) as i8));
    }

    /// Cuts off what is beyond a slab of what was taken out.
    #[inline(never)]
    fn clip(&mut self, triangle: &[Point; 3], plane: &Plane, cut: Cut, asked: u64, is_exact: bool) {
        self.sign_anew(triangle, plane);
        self.split(triangle, cut.cutter(), plane, asked, is_exact);
        std::mem::swap(&mut self.piece, &mut self.halves[usize::from(cut.keeps_back())]);
    }

    /// Puts a half of what was cut into a slot.
    #[inline(always)]
    fn put_half(&mut self, half: usize, slot: usize, part: Part, others: u64, corners: &mut Vec<Corner>) {
        let Ring { corners: own, sides } = &self.halves[half];
        let (first, count) = (corners.len() as u32, own.len() as u32);
        self.parts[slot] = Part { first, count, ..part };
        corners.extend_from_slice(own);
        self.sides.extend_from_slice(sides);
        let all = sides.iter().fold(Sides::default(), |all, sides| all.and(*sides));
        put(&mut self.table, slot, all.only(others));
    }

    /// Cuts what was taken out; the sides of new corners are only found for planes that are asked for.
    #[inline(always)]
    fn split(&mut self, triangle: &[Point; 3], cutter: Cutter, plane: &Plane, asked: u64, is_exact: bool) {
        let Self { table, piece, signs, halves, .. } = self;
        for half in &mut *halves {
            half.corners.clear();
            half.sides.clear();
        }
        if let Some(half) = uncut(signs) {
            return std::mem::swap(piece, &mut halves[half]);
        }
        let knife = Knife { triangle, line: plane.values(*triangle), sides: signs };
        // Both halves have each new corner, one after the other.
        let mut last = (usize::MAX, Sides::default());
        knife.split(&piece.corners, cutter, |half, corner, origin| {
            let sides = match origin {
                Origin::Corner(k) => piece.sides[k],
                Origin::Side(k) if k == last.0 => last.1,
                Origin::Side(k) => {
                    let lines = [piece.corners[k].line, knife.line];
                    last = (k, sides_of_made(&table.planes, triangle, corner.at, lines, asked, is_exact));
                    last.1
                }
            };
            halves[half].corners.push(corner);
            halves[half].sides.push(sides);
        });
    }
}

impl Gardener<'_> {
    /// Grows the tree of a few parts. If they are cut into more than there is room for, those that are left wait.
    pub(super) fn grow_few(
        &mut self,
        parts: &[Part],
        parent: Option<usize>,
        waiting: &mut Vec<Part>,
        tasks: &mut Vec<Waiting>,
    ) {
        self.lay(parts);
        let all = (1 << parts.len()) - 1;
        self.few.free = Set::MAX << FEW;
        self.few.tasks.clear();
        self.few.tasks.push((all, parent));
        while let Some((set, parent)) = self.few.tasks.pop() {
            if set.is_power_of_two() {
                self.end(set, parent);
            } else if !self.divide_few(set, parent) {
                self.few.tasks.push((set, parent));
                self.put_off(waiting, tasks);
            }
        }
    }

    /// Finds out on which sides of each other's planes they are.
    fn lay(&mut self, parts: &[Part]) {
        let Few { table, parts: slots, planes, cutters, shared, shared_sides, corners, sides, .. } =
            &mut self.few;
        let (tolerance, is_exact) = (self.rules.tolerance, self.rules.tolerance == 0.0);
        // Quicker than to look them up.
        let plane = |part: &Part| Plane::of(self.triangles[part.triangle as usize]);
        table.planes.lay(parts.iter().map(plane), tolerance);
        slots[..parts.len()].copy_from_slice(parts);
        shared.clear();
        for (k, part) in parts.iter().enumerate() {
            (planes[k], cutters[k]) = (k as u8, part.triangle);
            if part.is_whole() {
                let [a, b, c] = self.triangles[part.triangle as usize];
                corners[k] = [shared.number(a), shared.number(b), shared.number(c)];
            }
        }
        note_shared(&table.planes, &shared.points, is_exact, shared_sides);
        let mut wholes = [Sides::default(); FEW];
        for (whole, [a, b, c]) in wholes.iter_mut().zip(&corners[..parts.len()]) {
            let [a, b, c] =
                [shared_sides[usize::from(*a)], shared_sides[usize::from(*b)], shared_sides[usize::from(*c)]];
            *whole = a.and(b).and(c);
        }
        sides.resize(self.corners.len(), Sides::default());
        note(table, parts, self.triangles, &self.corners, is_exact, sides, &wholes);
    }

    /// A part alone.
    fn end(&mut self, set: Set, parent: Option<usize>) {
        let part = self.few.parts[set.trailing_zeros() as usize];
        self.few.free |= set & Set::MAX << FEW;
        self.keep(part);
        self.node(BspNode { triangle: part.triangle, own: 1, ..BspNode::default() }, parent);
    }

    /// Makes a node of some parts, if there is room for what is cut: at first there is.
    fn divide_few(&mut self, set: Set, parent: Option<usize>) -> bool {
        let few = &mut self.few;
        let planes = few.planes_of(set);
        let first = planes.trailing_zeros() as usize;
        // Of two, a plane that does not cut the other is as good as any.
        let is_good =
            self.rules.candidates == 1 || (set.count_ones() == 2 && few.table.divide(set, first).cut == 0);
        let plane = if is_good { first } else { best(&few.table, set, planes) };
        let Division { own, mut before, mut behind, cut } = few.table.divide(set, plane);
        few.free |= own & Set::MAX << FEW;
        if cut.count_ones() > few.free.count_ones() {
            few.free &= !own;
            return false;
        }
        self.keep_few(own);
        let clips = cut.count_ones() >= CLIPPED;
        for slot in slots(cut) {
            let [front, back] = self.split_few(slot, plane, planes, clips);
            before |= front;
            behind |= back;
        }
        let node = self.trees.nodes.len();
        let (own, front, back) = (own.count_ones(), before.count_ones(), behind.count_ones());
        let triangle = self.few.cutters[plane];
        self.node(BspNode { triangle, own, front, back, to_back: 0 }, parent);
        // What is before the plane comes next.
        for (set, parent) in [(behind, Some(node)), (before, None)] {
            if set != 0 {
                self.few.tasks.push((set, parent));
            }
        }
        true
    }

    /// Parts in one plane become pieces, lower triangles first.
    fn keep_few(&mut self, own: Set) {
        if own.is_power_of_two() {
            return self.keep(self.few.parts[own.trailing_zeros() as usize]);
        }
        for part in self.few.sorted(own) {
            self.keep(part);
        }
    }

    /// Cuts the part in a slot, of which nothing may be left on one side, or both, if it reached beyond its cell. Gives the slots
    /// of what is before the plane, and behind it.
    fn split_few(&mut self, slot: usize, plane: usize, planes: u64, clips: bool) -> [Set; 2] {
        let is_exact = self.rules.tolerance == 0.0;
        let part = self.few.parts[slot];
        let triangle = &self.triangles[part.triangle as usize];
        let others = planes & !(1 << self.few.planes[slot]);
        let slab_planes = self.slab_planes(part);
        let few = &mut self.few;
        few.open(slot, triangle, &self.corners);
        let mut left = part;
        if clips {
            for (plane, cut) in slab_planes {
                few.clip(triangle, &plane, cut, others, is_exact);
            }
            left.slabs = [Cut::NONE; 3];
        }
        let exact = few.table.planes.plane(plane);
        few.sign(triangle, plane, &exact, is_exact);
        // What is made lies in both planes.
        few.split(triangle, Cutter::Triangle(few.cutters[plane]), &exact, others & !(1 << plane), is_exact);
        few.free |= 1 << slot & Set::MAX << FEW;
        let (mut places, mut place) = ([0; 2], slot);
        for half in 0..2 {
            if !few.halves[half].corners.is_empty() {
                few.put_half(half, place, left, others, &mut self.corners);
                few.planes[place] = few.planes[slot];
                places[half] = 1 << place;
                few.free &= !(1 << place);
                place = few.free.trailing_zeros() as usize;
            }
        }
        places
    }

    /// What is left waits for another table.
    fn put_off(&mut self, waiting: &mut Vec<Part>, tasks: &mut Vec<Waiting>) {
        for (set, parent) in std::mem::take(&mut self.few.tasks) {
            tasks.push(Waiting { first: waiting.len(), parent });
            waiting.extend(self.few.sorted(set));
        }
    }
}
