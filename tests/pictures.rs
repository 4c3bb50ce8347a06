//! Antialiasing, layers that can be seen through, motion blur and depth of field, crop windows and parts of an image:
//! against what is worked out here by other means.

#![allow(clippy::disallowed_methods)] // what is worked out here need not be the same bits everywhere

use glam::{DAffine3, DMat3, DVec3, Vec3};
use micropoly::core::camera::{Camera, Light, Material};
use micropoly::{
    Backend, Batch, BezierPatch, Blur, Film, Filter, FrameOptions, Kernel, Lens, Rasteriser, RenderOptions,
    Rendering, Samples, Scene, SceneObject, Shading, Shape, Shot, Window, render, render_frames,
};

fn options(samples: Samples) -> RenderOptions {
    let frame = FrameOptions { width: 96, height: 54, samples, ..FrameOptions::default() };
    RenderOptions { frame, backend: Backend::Cpu, film: true, ..RenderOptions::default() }
}

fn rendered(scene: &Scene, options: &RenderOptions) -> Rendering {
    render(scene, options, |_| {}).expect("renders")
}

fn film(scene: &Scene, options: &RenderOptions) -> Film {
    rendered(scene, options).film.expect("it was asked for")
}

/// A flat patch at z = `depth` from x = -2 to 2 and y = -2 to 2.
fn sheet(depth: f32) -> BezierPatch {
    let at = |k: usize| [(k / 4) as f32 / 0.75 - 2.0, (k % 4) as f32 / 0.75 - 2.0, depth];
    BezierPatch { points: std::array::from_fn(at) }
}

fn object(patches: Vec<BezierPatch>, colour: Vec3, opacity: f32) -> SceneObject {
    let material = Material { colour, specular: 0.0, gloss: 0, opacity };
    SceneObject::new(Shape::of_bezier(patches), material)
}

/// Objects before a camera at z = 6 that looks down the z axis, in even light.
fn before_the_camera(objects: Vec<SceneObject>) -> Scene {
    Scene {
        name: "test".into(),
        camera: Camera::look_at(DVec3::Z * 6.0, DVec3::ZERO, DVec3::Y, 30.0, 0.1).expect("a view"),
        path: None,
        blur: Blur::default(),
        background: Vec3::new(0.25, 0.5, 0.75),
        ambient: Vec3::ONE,
        lights: Vec::new(),
        objects,
        notes: Vec::new(),
    }
}

fn teapot() -> Scene {
    let mut scene = Scene::load("scenes/teapot.toml").expect("a scene");
    scene.objects[0].motion.rotate = DVec3::new(0.0, 0.0, 40.0);
    scene
}

/// Root of the mean square of the differences of all values.
fn apart(a: &[[f64; 4]], b: &[[f64; 4]]) -> f64 {
    let squares: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / (4 * a.len()) as f64).sqrt()
}

fn values(film: &Film) -> Vec<[f64; 4]> {
    film.pixels.iter().map(|pixel| pixel.rgba.map(f64::from)).collect()
}

/// The mean of many pictures.
fn mean(pictures: impl Iterator<Item = Vec<[f64; 4]>>) -> Vec<[f64; 4]> {
    let (mut sum, mut count) = (Vec::new(), 0.0);
    for picture in pictures {
        sum.resize(picture.len(), [0.0; 4]);
        for (sum, value) in sum.iter_mut().zip(picture) {
            *sum = std::array::from_fn(|k| sum[k] + value[k]);
        }
        count += 1.0;
    }
    sum.iter().map(|sum| sum.map(|value| value / count)).collect()
}

#[test]
fn a_crop_window_shows_the_pixels_of_the_whole_image() {
    let scene = teapot();
    for (samples, kernel) in
        [(Samples::One, Kernel::Box), (Samples::Four, Kernel::Mitchell), (Samples::Sixteen, Kernel::Gaussian)]
    {
        let mut options = RenderOptions { filter: Filter::of(kernel), ..options(samples) };
        options.blur = (samples == Samples::Four).then(|| Blur { shutter: 0.5, ..Blur::default() });
        let whole = film(&scene, &options);
        let window = Window { left: 30, right: 71, top: 11, bottom: 40 };
        let crop = film(&scene, &RenderOptions { crop: Some(window), ..options.clone() });
        assert_eq!((crop.window, crop.size), (window, (96, 54)));
        for (index, pixel) in crop.pixels.iter().enumerate() {
            let (column, row) = (index as u32 % window.width() + 30, index as u32 / window.width() + 11);
            assert_eq!(*pixel, whole.pixels[(row * 96 + column) as usize], "{samples:?}: {column}, {row}");
        }
    }
    for crop in [(0, 97, 0, 5), (5, 5, 0, 1), (0, 1, 53, 55)] {
        let (left, right, top, bottom) = crop;
        let crop = Some(Window { left, right, top, bottom });
        let refused = render(&scene, &RenderOptions { crop, ..options(Samples::One) }, |_| {});
        assert!(refused.expect_err("no such window").to_string().contains("crop window"), "{crop:?}");
    }
}

#[test]
fn rasterisers_tiles_threads_and_parts_do_not_matter() {
    let mut glass = Scene::load("scenes/glass.toml").expect("a scene");
    glass.blur = Blur::default();
    for (scene, samples) in [
        (teapot(), Samples::One),
        (teapot(), Samples::Sixteen),
        (Scene::load("scenes/displaced.toml").expect("a scene"), Samples::Four),
        (Scene::load("scenes/gregory.toml").expect("a scene"), Samples::SixtyFour),
        (glass, Samples::Four),
    ] {
        let mut options = options(samples);
        options.filter = Filter::of(Kernel::Triangle);
        options.frame.shading = Shading::Smooth;
        let expected = film(&scene, &options);
        let check = |what: &str, options: &RenderOptions| {
            assert!(film(&scene, options) == expected, "{}, {samples:?}: {what}", scene.name);
        };
        for threads in [1, 3] {
            for rasteriser in Rasteriser::ALL {
                for tile in [0, 4, 8, 16, 32] {
                    let frame = FrameOptions { rasteriser, tile, ..options.frame };
                    check(
                        &format!("{rasteriser:?}, tile {tile}, {threads} threads"),
                        &RenderOptions { frame, threads, ..options.clone() },
                    );
                }
            }
        }
        let needed =
            match render(&scene, &RenderOptions { batch: Batch::Memory(1), ..options.clone() }, |_| {}) {
                Err(micropoly::Error::Plan(micropoly::core::error::PlanError::Budget { needed, .. })) => {
                    needed
                }
                other => panic!("one byte was enough: {:?}", other.map(|rendering| rendering.sizes)),
            };
        let least = RenderOptions { batch: Batch::Memory(needed), ..options.clone() };
        check("the least memory", &least);
        assert!(rendered(&scene, &least).bytes_allocated <= needed);
    }
}

#[test]
fn colours_of_an_edge_are_its_share_of_the_pixel() {
    // A white sheet whose right edge lies within the pixels of a column.
    let scene = before_the_camera(vec![object(vec![sheet(0.0)], Vec3::ONE, 1.0)]);
    for (samples, within) in [(Samples::Four, 0.26), (Samples::Sixteen, 0.07), (Samples::SixtyFour, 0.02)] {
        let film = film(&scene, &options(samples));
        let focal = 27.0 / (15.0_f64.to_radians()).tan();
        let edge = 48.0 + focal * 2.0 / 6.0;
        for column in 0..96 {
            let pixel = &film.pixels[27 * 96 + column];
            let share = (edge - column as f64).clamp(0.0, 1.0)
                - (48.0 - focal * 2.0 / 6.0 - column as f64).clamp(0.0, 1.0);
            assert!((f64::from(pixel.rgba[3]) - share).abs() < within, "{samples:?}, {column}: {pixel:?}");
            assert_eq!(pixel.rgba[0], pixel.rgba[3], "white times coverage");
            assert!((f64::from(pixel.covered) / f64::from(samples.count()) - share).abs() < within);
        }
    }
}

#[test]
fn layers_are_put_together_from_front_to_back() {
    let mut random = fastrand::Rng::with_seed(95);
    for round in 0..12 {
        // Sheets at any depths, in any order, some of which cross each other; the last one may hide all behind it.
        let count = random.usize(1..9);
        let sheets: Vec<(f32, f32, Vec3)> = (0..count)
            .map(|_| {
                let opacity = [0.2, 0.5, 0.9, 1.0][random.usize(0..4)];
                (random.f32() * 3.0 - 1.5, opacity, Vec3::new(random.f32(), random.f32(), random.f32()))
            })
            .collect();
        let objects = sheets
            .iter()
            .map(|&(depth, opacity, colour)| {
                let mut patch = sheet(depth);
                for point in &mut patch.points {
                    point[2] += point[0] * depth * 0.2; // they cross
                }
                object(vec![patch], colour, opacity)
            })
            .collect();
        let scene = before_the_camera(objects);
        for rasteriser in Rasteriser::ALL {
            let mut options = options(Samples::One);
            options.frame.rasteriser = rasteriser;
            let film = film(&scene, &options);
            for (column, row) in [(48, 27), (40, 20), (60, 35), (33, 27)] {
                // A ray through the pixel's middle meets each sheet where -z is the distance along it.
                let focal = 27.0 / (15.0_f64.to_radians()).tan();
                let slope = (f64::from(column) + 0.5 - 48.0) / focal;
                let mut hits: Vec<(f64, usize)> = sheets
                    .iter()
                    .enumerate()
                    .map(|(index, &(depth, ..))| {
                        // z = depth + x · depth / 5 and x = slope · (6 - z).
                        let (depth, k) = (f64::from(depth), f64::from(depth) * 0.2);
                        ((depth + 6.0 * k * slope) / (1.0 + k * slope), index)
                    })
                    .collect();
                hits.sort_by(|a, b| b.0.total_cmp(&a.0));
                let (mut wanted, mut open) = ([0.0; 4], 1.0);
                for (_, index) in &hits {
                    let (_, opacity, colour) = sheets[*index];
                    let share = open * f64::from(opacity);
                    for (k, value) in colour.to_array().into_iter().chain([1.0]).enumerate() {
                        wanted[k] += share * f64::from(value);
                    }
                    open *= 1.0 - f64::from(opacity);
                }
                let found = film.pixels[(row * 96 + column) as usize];
                let difference =
                    (0..4).map(|k| (f64::from(found.rgba[k]) - wanted[k]).abs()).fold(0.0, f64::max);
                assert!(difference < 1.0e-5, "round {round}, {column}: {found:?}, not {wanted:?}");
                assert_eq!(found.patch_id as usize, hits[0].1, "round {round}: the first layer");
            }
        }
    }
}

#[test]
fn a_spinning_teapot_is_the_mean_of_many_sharp_ones() {
    let scene = teapot();
    let blurred = |samples: Samples| {
        let blur = Some(Blur { shutter: 0.5, ..Blur::default() });
        values(&film(&scene, &RenderOptions { blur, ..options(samples) }))
    };
    let sharp = (0..128).map(|step| {
        let mut scene = teapot();
        let turned = 40.0 * 0.5 * (f64::from(step) + 0.5) / 128.0;
        let motion = std::mem::take(&mut scene.objects[0].motion);
        assert!(!motion.is_none());
        let to_world = scene.objects[0].to_world;
        scene.objects[0].to_world = DAffine3::from_rotation_z(turned.to_radians()) * to_world;
        values(&film(&scene, &options(Samples::Sixteen)))
    });
    let wanted = mean(sharp);
    let found: Vec<f64> = Samples::ALL.map(|samples| apart(&blurred(samples), &wanted)).to_vec();
    let unblurred = apart(&values(&film(&scene, &options(Samples::SixtyFour))), &wanted);
    assert!(found.windows(2).all(|pair| pair[1] < 0.8 * pair[0]), "{found:?}");
    assert!(found[3] < 0.006 && unblurred > 8.0 * found[3], "{found:?}, sharp {unblurred}");
}

#[test]
fn a_shallow_focus_is_the_mean_of_many_views_through_the_lens() {
    let scene = teapot();
    let lens = Lens { fstop: 0.012, focus: 8.0 };
    let blurred = |samples: Samples| {
        let blur = Some(Blur { lens: Some(lens), ..Blur::default() });
        values(&film(&scene, &RenderOptions { blur, ..options(samples) }))
    };
    // Pinholes all over the lens, each with the picture shifted so that what is 8 away stays: here by moving the eye and
    // skewing what it sees.
    let radius = 0.5 * 0.024 / (2.0 * 20.0_f64.to_radians().tan()) / lens.fstop;
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let views = (0..160).map(|step| {
        let out = radius * ((f64::from(step) + 0.5) / 160.0).sqrt();
        let (x, y) = (out * (golden * f64::from(step)).cos(), out * (golden * f64::from(step)).sin());
        let mut scene = teapot();
        let skew = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(-x / 8.0, -y / 8.0, 1.0));
        scene.camera.view = DAffine3::from_mat3(skew)
            * DAffine3::from_translation(DVec3::new(-x, -y, 0.0))
            * scene.camera.view;
        values(&film(&scene, &options(Samples::Sixteen)))
    });
    let wanted = mean(views);
    let found: Vec<f64> = Samples::ALL.map(|samples| apart(&blurred(samples), &wanted)).to_vec();
    let unblurred = apart(&values(&film(&scene, &options(Samples::SixtyFour))), &wanted);
    assert!(found.windows(2).all(|pair| pair[1] < 0.8 * pair[0]), "{found:?}");
    assert!(found[3] < 0.006 && unblurred > 4.0 * found[3], "{found:?}, sharp {unblurred}");
}

#[test]
fn a_point_out_of_focus_is_as_wide_as_a_thin_lens_makes_it() {
    // A tiny square at half the distance that is in focus.
    let mut small = sheet(0.0);
    small.points.iter_mut().flatten().for_each(|value| *value *= 0.02);
    let mut scene = before_the_camera(vec![object(vec![small], Vec3::ONE, 1.0)]);
    let fov = scene.camera.fov;
    let (fstop, focus) = (0.02, 12.0);
    scene.blur = Blur { lens: Some(Lens { fstop, focus }), ..Blur::default() };
    let film = film(&scene, &options(Samples::SixtyFour));
    let lit: Vec<(f64, f64)> = (0..96 * 54)
        .filter(|k| film.pixels[*k].covered > 0)
        .map(|k| ((k % 96) as f64 + 0.5 - 48.0, (k / 96) as f64 + 0.5 - 27.0))
        .collect();
    let widest = lit.iter().map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
    // Circle of confusion: diameter · |distance - focus| / distance, seen at the focus.
    let slope = (fov * 0.5).to_radians().tan();
    let diameter = 0.024 / (2.0 * slope) / fstop;
    let wanted = 0.5 * diameter * (12.0 - 6.0) / 6.0 / focus * 27.0 / slope;
    assert!((widest - wanted).abs() < 1.5, "{widest} pixels, not {wanted}");
    assert!(lit.len() > 40, "{}", lit.len());
}

#[test]
fn smooth_shading_is_closer_to_the_surface_where_micropolygons_are_large() {
    let mut scene = teapot();
    scene.lights.push(Light::Directional { to_light: DVec3::new(1.0, -1.0, 1.0), colour: Vec3::splat(0.4) });
    let with = |shading, size: f32| {
        let mut options = options(Samples::Sixteen);
        options.frame = FrameOptions { shading, size, bound: 16.0 * size, ..options.frame };
        film(&scene, &options)
    };
    let (fine, flat, smooth) =
        (with(Shading::Flat, 0.125), with(Shading::Flat, 4.0), with(Shading::Smooth, 4.0));
    // Outlines are as coarse with either, so it is the usual pixel that counts.
    let inner = |film: &Film| {
        let all = values(film).into_iter().enumerate();
        let whole = |k: usize| [&fine, &flat, &smooth].iter().all(|film| film.pixels[k].covered == 16);
        all.filter(|(k, _)| whole(*k)).map(|(_, value)| value).collect::<Vec<_>>()
    };
    let usual = |film: &Film| {
        let pairs = inner(film).into_iter().zip(inner(&fine));
        let mut apart: Vec<f64> = pairs.map(|(a, b)| (0..3).map(|k| (a[k] - b[k]).abs()).sum()).collect();
        apart.sort_by(f64::total_cmp);
        apart[apart.len() / 2]
    };
    let (flat, smooth) = (usual(&flat), usual(&smooth));
    assert!(smooth < 0.6 * flat, "{smooth}, flat {flat}");
}

#[test]
fn what_is_known_of_a_pixel_is_that_of_its_nearest_sample() {
    // A ball: normals point away from its middle, and the depth is that of a ball.
    let mut scene = Scene::load("scenes/spheres.toml").expect("a scene");
    let ball: Vec<BezierPatch> = scene.objects[0].shape.bezier[..8].to_vec();
    let (low, high) = ball
        .iter()
        .flat_map(|patch| patch.points)
        .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| {
            (low.min(Vec3::from(point)), high.max(Vec3::from(point)))
        });
    let (middle, radius) = ((low + high) * 0.5, (high.x - low.x) * 0.5);
    scene.objects[0].shape = Shape::of_bezier(ball).into();
    let eye = middle.as_dvec3() + DVec3::new(3.0, -4.0, 2.0) * f64::from(radius);
    scene.camera = Camera::look_at(eye, middle.as_dvec3(), DVec3::Z, 40.0, 0.001).expect("a view");
    for bumps in [None, Some(1.0e-6)] {
        // Hardly displaced at all: the same normals, found another way.
        scene.objects[0].displacement = bumps.map(|height| micropoly::core::displacement::Displacement {
            height,
            frequency: 1.0,
            octaves: 1,
        });
        let film = film(&scene, &options(Samples::Four));
        let mut covered = 0;
        for (index, (pixel, normal)) in film.pixels.iter().zip(&film.normals).enumerate() {
            if pixel.covered < 4 {
                assert!(pixel.covered > 0 || (*normal == [0.0; 3] && pixel.depth == 0));
                continue;
            }
            covered += 1;
            let distance = 1.0 / f64::from(f32::from_bits(pixel.depth));
            let focal = 27.0 / (20.0_f64.to_radians()).tan();
            let (x, y) = ((index % 96) as f64 + 0.5 - 48.0, (index / 96) as f64 + 0.5 - 27.0);
            let in_eye = DVec3::new(x / focal, -y / focal, -1.0) * distance;
            let point = scene.camera.view.inverse().transform_point3(in_eye);
            let outward = (point - middle.as_dvec3()).normalize();
            let cosine = outward.dot(Vec3::from(*normal).as_dvec3()).abs();
            // Within a pixel, which is some degrees wide at the rim.
            let facing = outward.dot((eye - point).normalize()).max(0.2);
            assert!(cosine > 1.0 - 0.01 / (facing * facing), "{index}: {normal:?}, not {outward}");
            assert!(((point - middle.as_dvec3()).length() / f64::from(radius) - 1.0).abs() < 0.1);
            assert!(pixel.patch_id < 8 && pixel.u < 1 << 24 && pixel.v < 1 << 24);
        }
        assert!(covered > 300, "{covered}");
    }
}

#[test]
fn sixteen_samples_of_8k_fit_a_small_budget() {
    let scene = teapot();
    let frame =
        FrameOptions { width: 7680, height: 4320, samples: Samples::Sixteen, ..FrameOptions::default() };
    let options = RenderOptions { frame, batch: Batch::Memory(32 << 20), ..options(Samples::Sixteen) };
    let sizes = micropoly::sizes_for(&scene, &options).expect("fits");
    assert!(sizes.bytes() <= 32 << 20, "{}", sizes.bytes());
    // All of it takes seconds; a part of it shows that the budget is kept.
    let crop = Some(Window { left: 3000, right: 3500, top: 2000, bottom: 2300 });
    let rendering = rendered(&scene, &RenderOptions { crop, film: false, ..options });
    assert!(rendering.bytes_allocated <= 32 << 20, "{}", rendering.bytes_allocated);
    assert_eq!((rendering.image.width, rendering.image.height), (500, 300));
}

#[test]
fn filters_blurs_and_opacities_that_cannot_be_are_refused() {
    let refusal = |scene: &Scene, options: &RenderOptions| {
        render(scene, options, |_| {}).map(|_| ()).expect_err("refused").to_string()
    };
    for radius in [0.0, 0.4, 4.5, f64::NAN] {
        let filter = Filter { kernel: Kernel::Box, radius };
        let said = refusal(&teapot(), &RenderOptions { filter, ..options(Samples::Four) });
        assert!(said.contains("radius"), "{said}");
    }
    for opacity in [0.0, -1.0, 1.5, f32::NAN] {
        let scene = before_the_camera(vec![object(vec![sheet(0.0)], Vec3::ONE, opacity)]);
        assert!(refusal(&scene, &options(Samples::One)).contains("opacity"), "{opacity}");
    }
    let wrong = [
        Blur { shutter: -1.0, ..Blur::default() },
        Blur { shutter: f64::NAN, ..Blur::default() },
        Blur { lens: Some(Lens { fstop: 0.0, focus: 1.0 }), ..Blur::default() },
        Blur { lens: Some(Lens { fstop: 1.0, focus: f64::INFINITY }), ..Blur::default() },
        Blur { sensor: 0.0, lens: Some(Lens { fstop: 1.0, focus: 1.0 }), ..Blur::default() },
    ];
    for blur in wrong {
        let said = refusal(&teapot(), &RenderOptions { blur: Some(blur), ..options(Samples::One) });
        assert!(said.contains("shutter") && said.contains("lens"), "{said}");
    }
}

#[test]
fn normals_are_in_world_space_wherever_the_camera_is_and_whatever_its_lens() {
    let mut scene = Scene::load("scenes/city.toml").expect("a scene");
    let options = options(Samples::One);
    let mut films = Vec::new();
    let shot = Shot::at(&scene, 300.0).expect("a frame");
    let mut keep = |_, rendering: Rendering| {
        films.push(rendering.film.expect("it was asked for"));
        Ok(())
    };
    render_frames(&scene, &options, &[shot], &mut keep).expect("renders");
    let lens = Some(Lens { fstop: 1.0e6, focus: 1.0 }); // as good as a pinhole
    let blurred = RenderOptions { blur: Some(Blur { lens, ..Blur::default() }), ..options.clone() };
    render_frames(&scene, &blurred, &[shot], &mut keep).expect("renders");
    scene.camera = scene.camera_at(300.0).expect("a camera");
    let still = film(&scene, &options);
    let upright = |normal: &[f32; 3]| normal.iter().filter(|k| k.abs() > 0.999).count() == 1;
    for moving in &films {
        let same = moving
            .normals
            .iter()
            .zip(&still.normals)
            .filter(|(a, b)| Vec3::from(**a).distance(Vec3::from(**b)) < 1.0e-4);
        assert!(same.count() * 10 > still.normals.len() * 9);
        // Houses are boxes: their walls and roofs face along an axis of the world.
        let boxes = moving.normals.iter().filter(|normal| upright(normal)).count();
        assert!(boxes * 2 > moving.normals.len(), "{boxes}");
    }
}
