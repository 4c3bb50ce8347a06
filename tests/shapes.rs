//! Shapes of every kind in pictures and meshes: closed where they are closed, the same however they are shared, round where
//! they are round, flat where they are to be flat.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};
use micropoly::core::displacement::Displacement;
use micropoly::mesh::Mesh;
use micropoly::quadric::Quadric;
use micropoly::{
    Backend, FrameOptions, Material, Oracle, Reading, RenderOptions, Rendering, Scene, SceneObject, Shape,
    render,
};

fn cages() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = ["cube", "creased_cube", "tetrahedra", "solids"]
        .map(|name| format!("scenes/cages/{name}.obj").into())
        .to_vec();
    let spot = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/models/spot_control_mesh.obj");
    if spot.exists() {
        files.push(spot);
    } else {
        println!("skipped: Spot, as there is no ../shared/data");
    }
    files
}

fn options(oracle: Oracle) -> RenderOptions {
    let frame = FrameOptions { width: 160, height: 90, oracle, ..FrameOptions::default() };
    RenderOptions { frame, backend: Backend::Cpu, ..RenderOptions::default() }
}

fn mesh(scene: &Scene, options: &RenderOptions) -> Mesh {
    let frame = FrameOptions { whole: true, ..options.frame };
    Mesh::of(scene, &RenderOptions { frame, ..options.clone() }).expect("a mesh").0
}

fn picture(scene: &Scene, options: &RenderOptions) -> Rendering {
    render(scene, options, |_| {}).expect("renders")
}

#[test]
fn closed_cages_are_closed_meshes() {
    for file in cages() {
        let mut scene = Scene::load(&file).expect("a scene");
        for oracle in Oracle::ALL {
            let mesh = mesh(&scene, &options(oracle));
            assert!(mesh.triangles.len() > 100, "{}: {}", file.display(), mesh.triangles.len());
            assert_eq!((mesh.open_edges(), mesh.limited), (0, 0), "{}, {}", file.display(), oracle.name());
        }
        scene.objects[0].displacement = Some(Displacement { height: 0.02, frequency: 5.0, octaves: 2 });
        let mesh = mesh(&scene, &options(Oracle::Size));
        assert_eq!((mesh.open_edges(), mesh.limited), (0, 0), "{}, displaced", file.display());
    }
}

#[test]
fn closed_cages_have_no_hole_from_inside() {
    // Those of one piece.
    let is_one = |file: &PathBuf| !file.ends_with("tetrahedra.obj") && !file.ends_with("solids.obj");
    for file in cages().into_iter().filter(is_one) {
        let mut scene = Scene::load(&file).expect("a scene");
        let (low, high) = scene.bounds();
        scene.background = Vec3::new(1.0, 0.0, 1.0);
        // From a point inside, nothing but the inside can be seen: found a little below the middle of some patch.
        let patch = scene.objects[0].shape.bezier.first().map(|patch| patch.points[5]);
        let patch = patch.or_else(|| scene.objects[0].shape.gregory.first().map(|patch| patch.points[12]));
        let surface = Vec3::from(patch.expect("a patch")).as_dvec3();
        let inwards = ((low + high) * 0.5 - surface).normalize();
        let eye = surface + inwards * (high - low).length() * 0.02;
        for (k, axis) in
            [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z].into_iter().enumerate()
        {
            let up = if k % 3 == 2 { DVec3::Y } else { DVec3::Z };
            let near = (high - low).length() * 1.0e-4;
            scene.camera = micropoly::Camera::look_at(eye, eye + axis, up, 92.0, near).expect("a view");
            for oracle in Oracle::ALL {
                let image = picture(&scene, &options(oracle)).image;
                let holes = image.rgb.as_chunks::<3>().0.iter().filter(|rgb| **rgb == [255, 0, 255]).count();
                assert_eq!(holes, 0, "{}, along {axis}, {}", file.display(), oracle.name());
            }
        }
    }
}

/// Three objects, two of them of the same patches.
fn objects(shape: &Arc<Shape>, is_shared: bool) -> Vec<SceneObject> {
    let ball = Quadric::Sphere { radius: 0.7, z_min: -0.7, z_max: 0.7, theta_max: 360.0 };
    let ball = Arc::new(Shape::of_rational(ball.patches().expect("patches")));
    let own = |shape: &Arc<Shape>| if is_shared { Arc::clone(shape) } else { Arc::new(Shape::clone(shape)) };
    let material =
        |red: f32| Material { colour: Vec3::new(red, 0.5, 0.4), specular: 0.3, gloss: 4, opacity: 1.0 };
    [(-1.6, 0.2, &ball), (0.0, 0.5, shape), (1.6, 0.9, &ball), (3.2, 0.7, shape)]
        .into_iter()
        .map(|(x, red, shape)| SceneObject {
            to_world: DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)),
            ..SceneObject::new(own(shape), material(red))
        })
        .collect()
}

#[test]
fn it_makes_no_difference_whether_objects_share_their_patches() {
    let mut scene = Scene::load("scenes/cages/creased_cube.obj").expect("a scene");
    let shape = Arc::clone(&scene.objects[0].shape);
    for is_displaced in [false, true] {
        let [shared, own] = [true, false].map(|is_shared| {
            scene.objects = objects(&shape, is_shared);
            if is_displaced {
                let bumps = Displacement { height: 0.05, frequency: 3.0, octaves: 2 };
                scene.objects[3].displacement = Some(bumps);
            }
            let oracles = if is_displaced { vec![Oracle::Size] } else { Oracle::ALL.to_vec() };
            let records = scene.for_device(&FrameOptions::default()).expect("a scene").patches.len();
            (
                records,
                oracles.into_iter().map(|oracle| picture(&scene, &options(oracle)).image).collect::<Vec<_>>(),
            )
        });
        assert_eq!(shared.1, own.1, "displaced: {is_displaced}");
        assert_eq!(2 * shared.0, own.0);
    }
}

#[test]
fn a_sphere_of_rational_patches_is_round() {
    let ball = Quadric::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, theta_max: 360.0 };
    let shape = Shape::of_rational(ball.patches().expect("patches"));
    assert!(!shape.rational.is_empty());
    let scene = Scene::around("ball".into(), shape).expect("a scene");
    for oracle in Oracle::ALL {
        let mesh = mesh(&scene, &options(oracle));
        assert_eq!((mesh.open_edges(), mesh.limited), (0, 0));
        for (position, normal) in mesh.positions.iter().zip(&mesh.normals) {
            let (at, normal) = (Vec3::from(*position).as_dvec3(), Vec3::from(*normal).as_dvec3());
            assert!((at.length() - 1.0).abs() <= 1.0e-6, "{at}");
            assert!(at.dot(normal) > 0.9999, "{at}: {normal}");
        }
    }
}

#[test]
fn flatness_needs_at_most_a_quarter_of_the_micropolygons() {
    let mut files = cages();
    files.push("scenes/teapot.toml".into());
    for file in files.iter().filter(|file| !file.ends_with("tetrahedra.obj")) {
        let scene = Scene::load(file).expect("a scene");
        let [size, flat] = Oracle::ALL.map(|oracle| {
            let options = options(oracle);
            let frame = FrameOptions { width: 640, height: 360, ..options.frame };
            picture(&scene, &RenderOptions { frame, ..options }).counts.micropolygons
        });
        assert!(4 * flat <= size, "{}: {flat} of {size}", file.display());
        assert!(flat > 100);
    }
}

#[test]
fn polygons_are_drawn_as_they_are_if_they_are_to_be() {
    let reading = Reading { polygons: true, ..Reading::default() };
    let scene = Scene::load_with("scenes/cages/cube.obj", &reading, &|_| {}).expect("a scene");
    let mesh = mesh(&scene, &options(Oracle::Size));
    assert_eq!(mesh.open_edges(), 0);
    for position in &mesh.positions {
        assert!(
            position.iter().any(|c| (c.abs() - 1.0).abs() < 1.0e-6),
            "{position:?} lies on no face of the cube"
        );
    }
    let flat = picture(&scene, &options(Oracle::Flatness));
    assert!(flat.counts.micropolygons <= 6, "{:?}", flat.counts);
}
