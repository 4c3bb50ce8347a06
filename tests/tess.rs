//! Meshes by levels: closed ones stay closed, memory makes no difference, and what cannot be is an error.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;
use micropoly::cage::Cage;
use micropoly::cage::generate::{Layout, torus_cage};
use micropoly::core::abi::{
    TESS_ISOLINES, TESS_LINEAR, TESS_PN, TESS_QUADS, TESS_UNIT, TessFrame, TessLevels, TessPatch, TessVertex,
};
use micropoly::core::tess::stream::{TessCounts, TessInput};
use micropoly::mesh::Mesh;
use micropoly::tess::chunk::each_chunk;
use micropoly::tess::{
    Control, Evaluation, HeightMap, Profile, Spacing, TessOptions, TessSource, Tessellated, tessellate,
};
use micropoly::{Backend, BezierPatch, Error};
use micropoly_backend_cpu::CpuDevice;

const SPACINGS: [Spacing; 3] = [Spacing::Equal, Spacing::FractionalEven, Spacing::FractionalOdd];
const EVALUATIONS: [Evaluation; 3] = [Evaluation::Linear, Evaluation::Pn, Evaluation::Phong];

fn options() -> TessOptions {
    TessOptions { backend: Backend::Cpu, ..TessOptions::default() }
}

/// A torus of triangles whose texture is torn: corners of the same vertex have different coordinates. Faces begin anywhere.
fn torn_torus(faces: u32) -> Cage {
    let mut random = fastrand::Rng::with_seed(7);
    let mut cage = torus_cage(faces, Layout::Triangles);
    for corners in cage.corners.chunks_exact_mut(3) {
        corners.rotate_left(random.usize(0..3));
    }
    cage.texture = (0..64).map(|_| [3.0 * random.f32() - 1.0, random.f32()]).collect();
    cage.texture_corners = cage.corners.iter().map(|_| random.u32(0..64)).collect();
    cage
}

fn bumps() -> HeightMap {
    let mut random = fastrand::Rng::with_seed(8);
    HeightMap { columns: 7, rows: 5, heights: (0..35).map(|_| random.f32()).collect() }
}

fn done(source: &TessSource, options: &TessOptions) -> Tessellated {
    tessellate(source, options, true).expect("tessellates")
}

fn mesh(source: &TessSource, options: &TessOptions) -> Mesh {
    done(source, options).mesh.expect("it was asked for")
}

#[test]
fn closed_meshes_stay_closed_whatever_levels_their_neighbours_have() {
    let source = TessSource::of_mesh(&torn_torus(200)).expect("sound");
    let eye = Some(DVec3::new(1.0, 0.5, 0.3));
    let mut meshes = 0;
    for control in
        [Control::Level(5.3), Control::Distance(7.0), Control::Pixels { pixels: 9.0, focal: 990.0 }]
    {
        for spacing in SPACINGS {
            for evaluation in EVALUATIONS {
                for profile in [Profile::D3d11, Profile::Stadlbauer] {
                    for heights in [None, Some((bumps(), 0.1))] {
                        let all =
                            TessOptions { control, eye, spacing, evaluation, profile, heights, ..options() };
                        assert_eq!(mesh(&source, &all).open_edges(), 0, "{all:?}");
                        meshes += 1;
                    }
                }
            }
        }
    }
    println!("{meshes} meshes of {} patches are closed", source.patches.len());
}

#[test]
fn triangles_that_are_lines_tear_no_heights() {
    // A tetrahedron with a corner cut off to a point: three vertices in one place, with other texture coordinates each.
    let place = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0], [1.0, 1.0, 1.0]];
    let corners = vec![0, 1, 2, 4, 3, 1, 0, 2, 3, 0, 3, 4, 0, 4, 1];
    let mesh_of = Cage {
        positions: place.to_vec(),
        face_sizes: vec![3; 5],
        texture: (0..15).map(|k| [k as f32 * 0.13, k as f32 * 0.29]).collect(),
        texture_corners: (0..15).collect(),
        corners,
        ..Cage::default()
    };
    let source = TessSource::of_mesh(&mesh_of).expect("sound");
    assert_eq!(source.patches.len(), 3, "those of no area are left out");
    let all = TessOptions { heights: Some((bumps(), 0.1)), ..options() };
    // Its bottom is missing.
    assert_eq!(mesh(&source, &all).open_edges(), 3 * 8);
}

#[test]
fn what_is_torn_is_seen() {
    // Without a rule whose heights hold, the same mesh is open: the check above can fail.
    let mut source = TessSource::of_mesh(&torn_torus(200)).expect("sound");
    for patch in &mut source.patches {
        patch.corners = std::array::from_fn(|k| patch.uv[k]);
        for edge in 0..3 {
            for (k, corner) in [(edge + 1) % 3, (edge + 2) % 3].into_iter().enumerate() {
                patch.edges[4 * edge + 2 * k..][..2].copy_from_slice(&patch.uv[2 * corner..][..2]);
            }
        }
    }
    let all = TessOptions { heights: Some((bumps(), 0.1)), ..options() };
    assert!(mesh(&source, &all).open_edges() > 100);
}

#[test]
fn bezier_patches_that_share_edges_stay_closed() {
    // A ring of four patches about an axis, one of them the other way round, with control points that neighbours share.
    let place = |i: usize, j: usize| {
        let turn = TAU * i as f64 / 12.0;
        let radius = 1.0 + 0.3 * libm::sin(j as f64);
        [(radius * libm::cos(turn)) as f32, (radius * libm::sin(turn)) as f32, j as f32 * 0.4]
    };
    let patches: Vec<BezierPatch> = (0..4)
        .map(|k| {
            let mut points = [[0.0; 3]; 16];
            for (at, point) in points.iter_mut().enumerate() {
                let (i, j) = (at / 4, at % 4);
                *point = if k == 2 { place((3 * k + 3 - i) % 12, 3 - j) } else { place((3 * k + i) % 12, j) };
            }
            BezierPatch { points }
        })
        .collect();
    let source = TessSource::of_bezier(&patches);
    for spacing in SPACINGS {
        let all = TessOptions { control: Control::Distance(9.0), eye: Some(DVec3::X), spacing, ..options() };
        let mesh = mesh(&source, &all);
        // Only the two rims are open; there each of the four patches has a vertex more than edges.
        let rim = mesh.positions.iter().filter(|p| p[2] == 0.0 || p[2] == 3.0 * 0.4).count();
        assert_eq!(mesh.open_edges(), rim - 8, "{spacing:?}");
    }
}

#[test]
fn memory_and_threads_make_no_difference() {
    let source = TessSource::of_mesh(&torn_torus(600)).expect("sound");
    let one = TessOptions {
        control: Control::Distance(20.0),
        heights: Some((bumps(), 0.1)),
        spacing: Spacing::FractionalOdd,
        ..options()
    };
    let wanted = done(&source, &one);
    assert_eq!(wanted.counts.chunks, 1);
    for (memory, threads) in [(600 << 10, 1), (700 << 10, 2), (1 << 20, 5)] {
        let found = done(&source, &TessOptions { memory, threads, ..one.clone() });
        assert!(found.counts.chunks > 1, "{memory}");
        assert_eq!(found.mesh, wanted.mesh, "{memory} bytes, {threads} threads");
        let counted = tessellate(&source, &TessOptions { memory, threads, ..one.clone() }, false);
        let counts = counted.expect("counts").counts;
        assert_eq!(
            TessCounts { chunks: 0, ..counts },
            TessCounts { chunks: 0, ..wanted.counts },
            "{memory} bytes"
        );
    }
}

#[test]
fn what_cannot_be_tessellated_is_an_error() {
    let torus = TessSource::of_mesh(&torn_torus(200)).expect("sound");
    let refused = |source: &TessSource, options: &TessOptions, what: &str| {
        let error = tessellate(source, options, true).expect_err(what).to_string();
        assert!(error.contains(what), "`{what}` is missing in: {error}");
    };
    for level in [0.0, -3.0, f32::NAN, f32::NEG_INFINITY] {
        refused(
            &torus,
            &TessOptions { control: Control::Level(level), ..options() },
            "every patch is dropped",
        );
    }
    let most = |level| done(&torus, &TessOptions { control: Control::Level(level), ..options() }).counts;
    assert_eq!(most(f32::INFINITY), most(64.0));
    assert_eq!(most(1.0e6), most(64.0));
    refused(&torus, &TessOptions { memory: 1000, ..options() }, "memory budget");
    let plain = TessSource::of_mesh(&torus_cage(200, Layout::Triangles)).expect("sound");
    let bumpy = TessOptions { heights: Some((bumps(), 0.1)), ..options() };
    refused(&plain, &bumpy, "texture coordinates");
    let flat = TessSource::of_bezier(&[BezierPatch { points: [[0.0; 3]; 16] }]);
    refused(&flat, &bumpy, "Bézier patches");
    let huge = TessOptions { heights: Some((bumps(), 1.0e9)), ..options() };
    refused(&torus, &huge, "scale");
    let nowhere =
        Cage { positions: vec![[0.0; 3]; 3], face_sizes: vec![3], corners: vec![0, 1, 9], ..Cage::default() };
    assert!(TessSource::of_mesh(&nowhere).expect_err("vertex 9").to_string().contains("vertex 9"));
    let far = Cage {
        positions: vec![[1.0e30; 3]; 3],
        face_sizes: vec![3],
        corners: vec![0, 1, 2],
        ..Cage::default()
    };
    assert!(TessSource::of_mesh(&far).is_err());
}

#[test]
fn frames_that_contradict_themselves_are_errors() {
    let patches = [TessPatch::default()];
    let frame = TessFrame { outer: [1.0; 4], inner: [1.0; 2], ..TessFrame::default() };
    let quads = TessFrame { domain: TESS_QUADS, evaluation: TESS_PN, ..frame };
    let heights = TessFrame { columns: 4, rows: 4, ..frame };
    let given = TessFrame { control: micropoly::core::abi::TESS_GIVEN, ..frame };
    for (frame, what) in [(quads, "PN"), (heights, "heights"), (given, "levels")] {
        let input = TessInput { frame, patches: &patches, levels: &[], heights: &[] };
        let error = each_chunk(&mut CpuDevice::new(1).expect("threads"), &input, 1 << 24, |_| Ok(()));
        assert!(error.expect_err(what).to_string().contains(what));
    }
    let empty = TessInput { frame, patches: &[], levels: &[], heights: &[] };
    let counts = each_chunk(&mut CpuDevice::new(1).expect("threads"), &empty, 1 << 24, |_| Ok(()));
    assert_eq!(counts.expect("nothing to do"), TessCounts::default());
}

#[test]
fn a_caller_that_fails_is_heard() {
    let source = TessSource::of_mesh(&torn_torus(600)).expect("sound");
    let frame =
        TessFrame { outer: [9.0; 4], inner: [9.0; 2], evaluation: TESS_LINEAR, ..TessFrame::default() };
    let input = TessInput { frame, patches: &source.patches, levels: &[], heights: &[] };
    let failed = each_chunk(&mut CpuDevice::new(0).expect("threads"), &input, 1 << 20, |_| {
        Err(Error::scene("the disk is full", "delete something"))
    });
    assert!(failed.expect_err("heard").to_string().contains("the disk is full"));
}

#[test]
fn control_and_evaluation_may_be_the_callers() {
    let source = TessSource::of_mesh(&torn_torus(200)).expect("sound");
    let frame = TessFrame { outer: [1.0; 4], inner: [1.0; 2], ..TessFrame::default() };
    let input = TessInput { frame, patches: &source.patches, levels: &[], heights: &[] };
    let mut device = CpuDevice::new(2).expect("threads");
    device.control_tessellation(Some(Arc::new(|index, _: &TessPatch| TessLevels {
        outer: [if index % 2 == 0 { 3.0 } else { 0.0 }; 4],
        inner: [2.0; 2],
    })));
    device.evaluate_tessellation(Some(Arc::new(|index, _: &TessPatch, [u, v, w]: [u32; 3]| TessVertex {
        position: [index as f32, u as f32, v as f32],
        normal: [w as f32, 0.0, 0.0],
        uv: [0.0; 2],
    })));
    let mut vertices = 0;
    let counts = each_chunk(&mut device, &input, 1 << 24, |chunk| {
        vertices += chunk.vertices.len();
        for vertex in &chunk.vertices {
            let sum = vertex.position[1] + vertex.position[2] + vertex.normal[0];
            assert_eq!((vertex.position[0] as u32 % 2, sum), (0, TESS_UNIT as f32));
        }
        Ok(())
    });
    let patches = source.patches.len().div_ceil(2);
    // Nine on the border, and one in the middle.
    assert_eq!((counts.expect("runs").vertices as usize, vertices), (10 * patches, 10 * patches));
    device.control_tessellation(None);
    device.evaluate_tessellation(None);
    let again = each_chunk(&mut device, &input, 1 << 24, |_| Ok(())).expect("runs");
    assert_eq!(again.primitives as usize, source.patches.len());
}

#[test]
fn isolines_are_lines() {
    let mut patch = TessPatch::default();
    patch.points[..12].copy_from_slice(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    let frame = TessFrame { domain: TESS_ISOLINES, outer: [4.0, 5.0, 0.0, 0.0], ..TessFrame::default() };
    let input = TessInput { frame, patches: &[patch], levels: &[], heights: &[] };
    let mut device = CpuDevice::new(1).expect("threads");
    let counts = each_chunk(&mut device, &input, 1 << 24, |chunk| {
        assert_eq!((chunk.corners, chunk.indices.len(), chunk.vertices.len()), (2, 2 * 4 * 5, 4 * 6));
        for [from, to] in chunk.indices.as_chunks::<2>().0 {
            let [from, to] = [from, to].map(|k| chunk.vertices[*k as usize].position);
            assert!(from[1] == to[1] && from[0] < to[0], "{from:?} {to:?}");
        }
        Ok(())
    });
    assert_eq!(counts.expect("runs").primitives, 20);
}
