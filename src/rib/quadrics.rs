//! The seven quadrics.

use super::geometry::Read;
use super::model::{RibGeometry, RibQuadric};
use super::parameters::{Declarations, Parameters};
use super::request::Request;
use crate::error::Result;

/// Arguments of any quadric: numbers, which may be an array, and then parameters.
pub(super) fn quadric(request: &mut Request, known: &Declarations) -> Result<Read> {
    let quadric = match request.name.as_str() {
        "Sphere" => {
            let [radius, z_min, z_max, theta_max] = request.list("radius, z min, z max and theta max")?;
            RibQuadric::Sphere { radius, z_min, z_max, theta_max }
        }
        "Cone" => {
            let [height, radius, theta_max] = request.list("height, radius and theta max")?;
            RibQuadric::Cone { height, radius, theta_max }
        }
        "Cylinder" => {
            let [radius, z_min, z_max, theta_max] = request.list("radius, z min, z max and theta max")?;
            RibQuadric::Cylinder { radius, z_min, z_max, theta_max }
        }
        "Hyperboloid" => {
            let [a, b, c, x, y, z, theta_max] = request.list("two points and theta max")?;
            RibQuadric::Hyperboloid { point1: [a, b, c], point2: [x, y, z], theta_max }
        }
        "Paraboloid" => {
            let [r_max, z_min, z_max, theta_max] = request.list("r max, z min, z max and theta max")?;
            RibQuadric::Paraboloid { r_max, z_min, z_max, theta_max }
        }
        "Disk" => {
            let [height, radius, theta_max] = request.list("height, radius and theta max")?;
            RibQuadric::Disk { height, radius, theta_max }
        }
        _ => {
            let [major, minor, phi_min, phi_max, theta_max] =
                request.list("major and minor radius, phi min, phi max and theta max")?;
            RibQuadric::Torus { major, minor, phi_min, phi_max, theta_max }
        }
    };
    Ok((RibGeometry::Quadric(quadric), Parameters::of(request, known)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{geometry, wrong};

    #[test]
    fn quadrics_have_their_parameters_in_order() {
        for (request, expected) in [
            (
                "Sphere 2 -1 1 180",
                RibQuadric::Sphere { radius: 2.0, z_min: -1.0, z_max: 1.0, theta_max: 180.0 },
            ),
            (
                "Sphere [2 -1 1 180]",
                RibQuadric::Sphere { radius: 2.0, z_min: -1.0, z_max: 1.0, theta_max: 180.0 },
            ),
            ("Cone 3 2 360", RibQuadric::Cone { height: 3.0, radius: 2.0, theta_max: 360.0 }),
            (
                "Cylinder 2 0 5 90",
                RibQuadric::Cylinder { radius: 2.0, z_min: 0.0, z_max: 5.0, theta_max: 90.0 },
            ),
            (
                "Hyperboloid 1 0 0 [0 1 2] 360",
                RibQuadric::Hyperboloid {
                    point1: [1.0, 0.0, 0.0],
                    point2: [0.0, 1.0, 2.0],
                    theta_max: 360.0,
                },
            ),
            (
                "Paraboloid 1 0 2 360",
                RibQuadric::Paraboloid { r_max: 1.0, z_min: 0.0, z_max: 2.0, theta_max: 360.0 },
            ),
            ("Disk 0.5 2 360", RibQuadric::Disk { height: 0.5, radius: 2.0, theta_max: 360.0 }),
            (
                "Torus 4 1 0 180 270",
                RibQuadric::Torus { major: 4.0, minor: 1.0, phi_min: 0.0, phi_max: 180.0, theta_max: 270.0 },
            ),
        ] {
            assert_eq!(geometry(request), RibGeometry::Quadric(expected), "{request}");
        }
    }

    #[test]
    fn quadrics_need_all_their_numbers() {
        assert_eq!(
            wrong("\nDisk 0\n1"),
            "x.rib:2: `Disk`: its height, radius and theta max has 2 numbers\n  help: give it 3"
        );
        assert!(wrong("Sphere [1 2 3 4 5]").contains("has 5 numbers"));
        assert!(wrong("Sphere \"P\" [1]").contains("should stand here"));
        assert!(wrong("Sphere 1 -1 1 1e13").contains("beyond 1e12"));
    }
}
