//! Transparency in order: what is seen at each pixel is what sorting all of its hits says, whatever triangles do to each other.

#![cfg(feature = "cpu")]
#![allow(clippy::disallowed_methods)] // what is worked out here need not be the same bits everywhere

use glam::{DVec3, Vec3};
use micropoly::cage::generate::{Layout, torus_cage};
use micropoly::core::camera::{Camera, Material};
use micropoly::polygon::{bilinear, polygons};
use micropoly::{
    Backend, Batch, Blur, FrameOptions, Lens, Ordering, RenderOptions, Rendering, Samples, Scene,
    SceneObject, Shape, Transparency, Window, render,
};

type Triangle = [DVec3; 3];

fn ordered(grid: Option<u32>) -> RenderOptions {
    let frame = FrameOptions { width: 96, height: 54, ..FrameOptions::default() };
    let transparency = Transparency::Order(Ordering { grid, tolerance: 0.0 });
    RenderOptions { frame, transparency, backend: Backend::Cpu, film: true, ..RenderOptions::default() }
}

fn layered() -> RenderOptions {
    RenderOptions { transparency: Transparency::Layers, ..ordered(None) }
}

fn rendered(scene: &Scene, options: &RenderOptions) -> Rendering {
    render(scene, options, |_| {}).expect("renders")
}

/// Objects of some triangles each, in even light.
fn scene(objects: Vec<SceneObject>, camera: Camera) -> Scene {
    Scene {
        name: "test".into(),
        camera,
        path: None,
        blur: Blur::default(),
        background: Vec3::new(0.25, 0.5, 0.75),
        ambient: Vec3::ONE,
        lights: Vec::new(),
        objects,
        notes: Vec::new(),
    }
}

fn object(triangles: &[Triangle], colour: Vec3, opacity: f32) -> SceneObject {
    let patch = |[a, b, c]: &Triangle| bilinear([a, b, c, c].map(|corner| corner.to_array()));
    let shape = Shape::of_polygons(triangles.iter().map(patch).collect());
    SceneObject::new(shape, Material { colour, specular: 0.0, gloss: 0, opacity })
}

/// Triangles on a lattice of 1/64, so that nothing is rounded, about the origin.
fn soup(random: &mut fastrand::Rng, count: usize, size: i32) -> Vec<Triangle> {
    let mut triangle = || {
        let place = [0; 3].map(|_| random.i32(-64..64));
        let corner =
            |random: &mut fastrand::Rng| place.map(|c| f64::from(c + random.i32(-size..size)) / 64.0);
        [0; 3].map(|_| DVec3::from(corner(random)))
    };
    (0..count).map(|_| triangle()).collect()
}

fn look(random: &mut fastrand::Rng, reach: f64) -> Camera {
    let mut any = || DVec3::from([0; 3].map(|_| random.f64() - 0.5));
    let (eye, target) = (any() * 2.0 * reach, any());
    Camera::look_at(eye, target, DVec3::new(0.1, 1.0, 0.2), 60.0, 1.0e-3).expect("a view")
}

/// Where a ray hits a triangle, and how near to an edge.
fn hit(origin: DVec3, ray: DVec3, [a, b, c]: &Triangle) -> Option<(f64, f64)> {
    let normal = (*b - *a).cross(*c - *a);
    let area = normal.length_squared();
    let slope = normal.dot(ray);
    if area == 0.0 || slope == 0.0 {
        return None;
    }
    let t = normal.dot(*a - origin) / slope;
    let place = origin + ray * t;
    let weight = |p: DVec3, q: DVec3| (q - p).cross(place - p).dot(normal) / area;
    let edge = weight(*a, *b).min(weight(*b, *c)).min(weight(*c, *a));
    // What is seen from the side, or up close, is as good as on an edge.
    let aslant = (slope / (area.sqrt() * ray.length())).abs();
    (t > -1.0e-2 && edge > -1.0e-2).then_some((t, if t < 2.0e-3 || aslant < 1.0e-3 { 0.0 } else { edge }))
}

/// What all triangles look like through the middle of a pixel, by sorting; `None` where that hangs by a thread.
fn wanted(
    objects: &[(Vec<Triangle>, Vec3, f32)],
    scene: &Scene,
    options: &FrameOptions,
    at: [u32; 2],
) -> Option<Vec3> {
    let (camera, focal) = (scene.camera.view.inverse(), scene.camera.focal(options.height));
    let x = f64::from(at[0]) + 0.5 - 0.5 * f64::from(options.width);
    let y = f64::from(at[1]) + 0.5 - 0.5 * f64::from(options.height);
    let ray = camera.transform_vector3(DVec3::new(x / focal, -y / focal, -1.0));
    let mut hits = Vec::new();
    for (number, (triangles, colour, opacity)) in (0..).zip(objects) {
        for (k, triangle) in triangles.iter().enumerate() {
            let Some((t, edge)) = hit(camera.translation, ray, triangle) else { continue };
            if edge.abs() < 1.0e-3 {
                return None;
            }
            if edge > 0.0 {
                hits.push((t, number, k, *colour, *opacity, triangle));
            }
        }
    }
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    for pair in hits.windows(2) {
        if pair[1].0 - pair[0].0 < 1.0e-5 && !is_coplanar(pair[0].5, pair[1].5) {
            return None;
        }
    }
    // Of those in one plane the lower patch is in front.
    hits.sort_by(|a, b| {
        let same = (a.0 - b.0).abs() < 1.0e-5;
        if same { (a.1, a.2).cmp(&(b.1, b.2)) } else { a.0.total_cmp(&b.0) }
    });
    let (mut all, mut left) = (Vec3::ZERO, 1.0);
    for (_, _, _, colour, opacity, _) in hits {
        all += colour * opacity * left;
        left *= 1.0 - opacity;
    }
    Some(all + scene.background * left)
}

fn is_coplanar(a: &Triangle, b: &Triangle) -> bool {
    let normal = (a[1] - a[0]).cross(a[2] - a[0]);
    b.iter().all(|corner| normal.dot(*corner - a[0]) == 0.0)
}

/// Compares all pixels from some eyes; gives how many there were and how many showed something.
fn check(objects: &[(Vec<Triangle>, Vec3, f32)], eyes: usize, grid: Option<u32>) -> (usize, usize) {
    let mut random = fastrand::Rng::with_seed(11);
    let (mut compared, mut covered) = (0, 0);
    for eye in 0..eyes {
        let camera = look(&mut random, [0.8, 3.0, 20.0][eye % 3]);
        let all =
            objects.iter().map(|(triangles, colour, opacity)| object(triangles, *colour, *opacity)).collect();
        let (scene, options) = (scene(all, camera), ordered(grid));
        let film = rendered(&scene, &options).film.expect("it was asked for");
        for (k, pixel) in film.pixels.iter().enumerate() {
            let at = [k as u32 % options.frame.width, k as u32 / options.frame.width];
            let Some(wanted) = wanted(objects, &scene, &options.frame, at) else { continue };
            let [r, g, b, coverage] = pixel.rgba;
            let found = Vec3::new(r, g, b) + scene.background * (1.0 - coverage);
            assert!((found - wanted).abs().max_element() < 1.0e-5, "eye {eye}, {at:?}: {found} {wanted}");
            compared += 1;
            covered += usize::from(pixel.depth != 0);
        }
    }
    (compared, covered)
}

const RED: Vec3 = Vec3::new(0.9, 0.2, 0.1);
const BLUE: Vec3 = Vec3::new(0.1, 0.3, 0.8);

#[test]
fn pixels_are_those_of_sorting_whatever_triangles_cut_each_other() {
    let mut random = fastrand::Rng::with_seed(1);
    for (count, size, grid) in [(3, 60, Some(1)), (20, 70, Some(1)), (20, 60, None), (60, 25, Some(4))] {
        let objects =
            [(soup(&mut random, count, size), RED, 0.4), (soup(&mut random, count, size), BLUE, 0.7)];
        let (compared, covered) = check(&objects, 24, grid);
        assert!(compared > 24 * 4000 && covered > compared / 50, "{compared} {covered}");
    }
}

#[test]
fn pixels_are_those_of_sorting_where_triangles_share_planes() {
    let mut random = fastrand::Rng::with_seed(2);
    let mut sheets = |aslant: f64| -> Vec<Triangle> {
        let mut corner = |level: f64| {
            let [x, y] = [0; 2].map(|_| f64::from(random.i32(-64..64)) / 32.0);
            DVec3::new(x, y, level + aslant * x)
        };
        (0..24).map(|k| [0; 3].map(|_| corner(f64::from(k % 3) * 0.25))).collect()
    };
    let objects = [(sheets(0.0), RED, 0.4), (sheets(0.0), BLUE, 0.6), (sheets(0.5), RED, 1.0)];
    let (compared, covered) = check(&objects, 24, Some(2));
    assert!(compared > 24 * 4000 && covered > compared / 50, "{compared} {covered}");
}

/// Two tori of triangles that cut each other.
fn tori() -> Scene {
    let cage = torus_cage(900, Layout::Triangles);
    let shape = Shape::of_polygons(polygons(&cage).expect("they can be drawn"));
    let material = |colour, opacity| Material { colour, specular: 0.3, gloss: 3, opacity };
    let mut second = SceneObject::new(shape.clone(), material(BLUE, 0.6));
    second.to_world = glam::DAffine3::from_translation(DVec3::new(0.7, 0.2, 0.1));
    second.motion.translate = DVec3::new(0.0, 0.4, 0.0);
    let camera =
        Camera::look_at(DVec3::new(1.0, -5.0, 3.0), DVec3::ZERO, DVec3::Z, 40.0, 0.01).expect("a view");
    let light = micropoly::Light::Directional { to_light: DVec3::new(1.0, -1.0, 2.0), colour: Vec3::ONE };
    let ambient = Vec3::splat(0.2);
    let objects = vec![SceneObject::new(shape, material(RED, 0.5)), second];
    Scene { ambient, lights: vec![light], ..scene(objects, camera) }
}

/// Share of the pixels that differ by more than a little.
fn different(a: &Rendering, b: &Rendering) -> f64 {
    let (a, b) = (&a.image.rgb, &b.image.rgb);
    let apart =
        a.chunks(3).zip(b.chunks(3)).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 4));
    apart.count() as f64 / (a.len() / 3) as f64
}

#[test]
fn it_looks_as_layer_by_layer() {
    let scene = tori();
    let lens = Some(Lens { fstop: 0.02, focus: 5.5 });
    let blurs = [Blur::default(), Blur { shutter: 1.0, ..Blur::default() }, Blur { lens, ..Blur::default() }];
    for (blur, samples) in [
        (blurs[0], Samples::One),
        (blurs[0], Samples::Sixteen),
        (blurs[1], Samples::Four),
        (blurs[2], Samples::Four),
    ] {
        let with = |options: RenderOptions| {
            let frame = FrameOptions { samples, ..options.frame };
            rendered(&scene, &RenderOptions { frame, blur: Some(blur), ..options })
        };
        let (order, layers) = (with(ordered(None)), with(layered()));
        let share = different(&order, &layers);
        assert!(share < 0.03, "{blur:?} {samples:?}: {share}");
        assert!(different(&order, &rendered(&scene, &ordered(None))) > 0.01 || samples == Samples::One);
    }
}

#[test]
fn nothing_else_changes_the_image() {
    let scene = tori();
    let sixteen = |options: RenderOptions| {
        let frame = FrameOptions { samples: Samples::Sixteen, ..options.frame };
        RenderOptions { frame, ..options }
    };
    let wanted = rendered(&scene, &sixteen(ordered(None)));
    for grid in [1, 3, 20] {
        assert_eq!(
            rendered(&scene, &sixteen(ordered(Some(grid)))).image.hash(),
            wanted.image.hash(),
            "{grid}"
        );
    }
    let threads = RenderOptions { threads: 1, ..sixteen(ordered(None)) };
    assert_eq!(rendered(&scene, &threads).image.hash(), wanted.image.hash());
    let memory = RenderOptions { batch: Batch::Memory(3 << 20), ..sixteen(ordered(None)) };
    let in_parts = rendered(&scene, &memory);
    assert!(in_parts.parts > 1);
    assert_eq!(in_parts.image.hash(), wanted.image.hash());
    let crop = Window { left: 30, right: 60, top: 10, bottom: 40 };
    let cropped = rendered(&scene, &RenderOptions { crop: Some(crop), ..sixteen(ordered(None)) });
    for (row, pixels) in cropped.image.rgb.chunks(90).enumerate() {
        let first = 3 * ((row + 10) * 96 + 30);
        assert_eq!(pixels, &wanted.image.rgb[first..first + 90]);
    }
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_built()) {
        match render(&scene, &RenderOptions { backend, ..sixteen(ordered(None)) }, |_| {}) {
            Ok(other) => assert_eq!(other.image.hash(), wanted.image.hash(), "{backend:?}"),
            Err(error) if std::env::var_os("CI").is_some() => panic!("{backend:?}: {error}"),
            Err(error) => eprintln!("skipped: {backend:?}: {error}"),
        }
    }
}

#[test]
fn backs_can_be_left_out() {
    let scene = tori();
    let options = |transparency, cull_backfaces| {
        let frame = FrameOptions { cull_backfaces, ..layered().frame };
        RenderOptions { frame, transparency, ..layered() }
    };
    let order = Transparency::Order(Ordering::default());
    let share = |a, b, culled| {
        different(&rendered(&scene, &options(a, culled)), &rendered(&scene, &options(b, true)))
    };
    // The other way round it would be 0.16.
    assert!(share(order, Transparency::Layers, true) < 0.05);
    assert!(share(order, order, false) > 0.1);
}

#[test]
fn what_cannot_be_sorted_is_an_error() {
    let message = |scene: &Scene| {
        let error = render(scene, &ordered(None), |_| {}).expect_err("cannot be sorted");
        error.to_string()
    };
    let teapot = Scene::load("scenes/teapot.toml").expect("a scene");
    assert!(message(&teapot).contains("has curved patches"), "{}", message(&teapot));
    let mut far = tori();
    far.camera = Camera::look_at(DVec3::Y * -1.0e4, DVec3::ZERO, DVec3::Z, 1.0, 0.01).expect("a view");
    assert!(message(&far).contains("times as far away"), "{}", message(&far));
}
