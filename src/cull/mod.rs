//! Culling of whole patches, before any of them is bounded: those of which the frame sees nothing, and those behind what has
//! been drawn so far. Neither changes a bit of the image.
//!
//! Patches are taken in waves, from front to back; before each wave the depths are read back that the waves before it left
//! (`depths.rs`). Where waves end depends on the scene and its options only, so what is culled does, too.

mod depths;
mod front;

use std::time::Instant;

use micropoly_core::abi::{Frame, Object, Patch};
use micropoly_core::backend::Device;
use micropoly_core::cull::{Outline, Sight};
use micropoly_core::memory::MOST_LISTED;
use micropoly_core::render::{Buffers, Counts, FramePlan};
use rayon::prelude::*;

use self::depths::Depths;
use self::front::Front;

/// Which patches are left out. The image does not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cull {
    /// None: every surface is looked at by itself.
    #[default]
    None,
    /// Those that can touch no sample of the frame.
    Frustum,
    /// Those, too, that are behind what has been drawn before.
    Occlusion,
}

impl Cull {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Frustum, Self::Occlusion];

    /// Its name on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Frustum => "frustum",
            Self::Occlusion => "occlusion",
        }
    }

    /// Roots that can be listed at once.
    pub(crate) fn listed(self, patches: u32) -> u32 {
        if self == Self::None { 0 } else { patches.min(MOST_LISTED) }
    }
}

/// What became of patches, in all parts of the image and all passes together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Roots {
    /// They were bounded.
    pub taken: u64,
    /// They can touch no sample.
    pub outside: u64,
    /// They are behind what was drawn before.
    pub hidden: u64,
    /// Waves in which they were taken.
    pub waves: u64,
}

/// A wave has a patch for so many samples, so that looking at all depths takes little time beside drawing it …
const SAMPLES_A_PATCH: u64 = 128;
/// … and no fewer than that, unless it was asked for.
const LEAST_WAVE: u64 = 1 << 10;
/// The next wave is twice as large if fewer than one in so many boxes was hidden that came before a wave.
const SELDOM: usize = 32;

/// Culls patches, view after view.
pub(crate) struct Culling<'a> {
    cull: Cull,
    /// Patches a wave; 0 = as many as pay.
    wave: u32,
    patches: &'a [Patch],
    patch_count: u32,
    /// Where all patches are seen in one of the views.
    sights: Vec<Sight>,
    view: Option<usize>,
    pub(crate) roots: Roots,
    pub(crate) seconds: f64,
}

/// A view of a scene, by number, and what of it is rendered.
pub(crate) struct View<'a> {
    pub(crate) number: usize,
    pub(crate) frame: Frame,
    pub(crate) objects: &'a [Object],
}

impl<'a> Culling<'a> {
    pub(crate) fn new(cull: Cull, wave: u32, patches: &'a [Patch], patch_count: u32) -> Self {
        let (sights, view, roots, seconds) = (Vec::new(), None, Roots::default(), 0.0);
        Self { cull, wave, patches, patch_count, sights, view, roots, seconds }
    }

    /// Renders a view, as [`FramePlan::run`] does; `progress` is told which share of its patches is done with.
    pub(crate) fn run<D: Device>(
        &mut self,
        device: &mut D,
        plan: &FramePlan,
        buffers: &mut Buffers<D::Buffer>,
        view: &View<'_>,
        mut progress: impl FnMut(f64, &Counts),
    ) -> Result<Counts, D::Error> {
        if self.cull == Cull::None {
            let all = f64::from(self.patch_count);
            let counts = plan.run(device, buffers, |own| progress(own.roots_taken as f64 / all, own))?;
            self.roots.taken += counts.roots_taken;
            return Ok(counts);
        }
        let start = Instant::now();
        let (inside, outlines) = self.inside(view);
        self.seconds += start.elapsed().as_secs_f64();
        self.roots.outside += u64::from(self.patch_count) - inside.len() as u64;
        let wave = self.wave_of(plan, view);
        if self.cull == Cull::Occlusion && inside.len() > wave {
            return self.in_waves(device, plan, buffers, (view, (&inside, &outlines), wave), progress);
        }
        let mut counts = Counts::default();
        for roots in inside.chunks(plan.sizes().listed as usize) {
            let own = plan.run_listed(device, buffers, roots, |own| {
                progress((counts.roots_taken + own.roots_taken) as f64 / inside.len() as f64, own);
            })?;
            counts = counts.and(own);
            self.roots.waves += 1;
        }
        self.roots.taken += inside.len() as u64;
        Ok(counts)
    }

    /// Patches of the first wave.
    fn wave_of(&self, plan: &FramePlan, view: &View<'_>) -> usize {
        let wanted = match self.wave {
            0 => (view.frame.sample_count() / SAMPLES_A_PATCH).max(LEAST_WAVE),
            wave => u64::from(wave),
        };
        wanted.min(u64::from(plan.sizes().listed)) as usize
    }

    /// The patches that can touch a sample, and their outlines.
    fn inside(&mut self, view: &View<'_>) -> (Vec<u32>, Vec<Outline>) {
        if self.view != Some(view.number) {
            let own = |patch| Sight::of_patch(&view.frame, view.objects, self.patches, patch);
            (0..self.patch_count).into_par_iter().map(own).collect_into_vec(&mut self.sights);
            self.view = Some(view.number);
        }
        let outline = |(patch, sight)| Some((patch, Outline::of(&view.frame, sight)?));
        (0..self.patch_count).into_par_iter().zip(&self.sights).filter_map(outline).unzip()
    }

    /// Renders these patches from front to back, in waves, but for those that are hidden.
    fn in_waves<D: Device>(
        &mut self,
        device: &mut D,
        plan: &FramePlan,
        buffers: &mut Buffers<D::Buffer>,
        (view, (inside, outlines), least): (&View<'_>, (&[u32], &[Outline]), usize),
        mut progress: impl FnMut(f64, &Counts),
    ) -> Result<Counts, D::Error> {
        let start = Instant::now();
        let mut front = Front::new(outlines);
        self.seconds += start.elapsed().as_secs_f64();
        let (mut counts, mut depths, mut wave) = (Counts::default(), Depths::default(), least);
        loop {
            let start = Instant::now();
            let mut roots = Vec::with_capacity(wave);
            let hidden = front.take(&depths, wave, &mut roots);
            for root in &mut roots {
                *root = inside[*root as usize];
            }
            self.seconds += start.elapsed().as_secs_f64();
            if !roots.is_empty() {
                let own = plan.run_listed(device, buffers, &roots, |own| {
                    progress((counts.roots_taken + own.roots_taken) as f64 / inside.len() as f64, own);
                })?;
                counts = counts.and(own);
                self.roots.waves += 1;
            }
            if front.is_done() {
                self.roots.taken += counts.roots_taken;
                self.roots.hidden += inside.len() as u64 - counts.roots_taken;
                return Ok(counts);
            }
            let is_seldom = !depths.is_empty() && hidden * SELDOM < roots.len();
            wave = if is_seldom { (2 * wave).min(plan.sizes().listed as usize) } else { least };
            let start = Instant::now();
            depths.read(device, buffers, &view.frame)?;
            self.seconds += start.elapsed().as_secs_f64();
        }
    }
}
