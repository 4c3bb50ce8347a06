use micropoly::{FrameOptions, Scene};
use micropoly_backend_cpu::CpuDevice;
use micropoly_backend_wgpu::WgpuDevice;
use micropoly_conformance::Case;
use micropoly_core::abi::*;
use micropoly_core::backend::Device;
use micropoly_core::render::FramePlan;
fn samples<D: Device>(d: &mut D, c: &Case) -> Vec<Sample>
where
    D::Error: std::fmt::Debug,
{
    let plan = FramePlan::new(c.frame, c.patches.len() as u32, c.objects.len() as u32, 4096).unwrap();
    let b = plan.prepare(d, &c.objects, &c.patches).unwrap();
    plan.run(d, &b, |_| {}).unwrap();
    let mut out = vec![Sample::default(); 320 * 180];
    d.read(&b.samples, 0, &mut out).unwrap();
    out
}
#[test]
fn time() {
    let path = format!("{}/../scenes/spheres.toml", env!("CARGO_MANIFEST_DIR"));
    let device = Scene::load(path)
        .unwrap()
        .for_device(&FrameOptions { width: 320, height: 180, ..FrameOptions::default() })
        .unwrap();
    let c =
        Case { name: String::new(), frame: device.frame, objects: device.objects, patches: device.patches };
    let want = samples(&mut CpuDevice::new(1).unwrap(), &c);
    for (name, edits) in [
        ("as is", &[][..] as &[(&str, &str, &str)]),
        ("canary trips?", &[("draw.wgsl", "index < listed", "index < 100000u")][..]),
    ] {
        let edit = |file: &str, source: &str| {
            let mut s = source.to_owned();
            for (f, a, b) in edits {
                if *f == file {
                    assert!(s.contains(a));
                    s = s.replace(a, b);
                }
            }
            s
        };
        let mut g = WgpuDevice::open(0, Some(&edit)).unwrap();
        let got = samples(&mut g, &c);
        let mut tiles = std::collections::BTreeMap::new();
        for (i, (a, b)) in want.iter().zip(&got).enumerate() {
            if a != b {
                *tiles.entry(((i % 320) / 16, i / 320 / 16)).or_insert(0) += 1;
            }
        }
        println!("{name} differ in tiles {tiles:?}");
    }
}
