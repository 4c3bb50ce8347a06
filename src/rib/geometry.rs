//! Requests that draw something.

use super::curves;
use super::model::RibGeometry;
use super::parameters::{Class, Parameter, Parameters};
use super::patches::{self, Bases};
use super::place::quoted;
use super::polygons;
use super::quadrics;
use super::reader::Reader;
use super::request::Request;
use super::subdivision;
use super::view::sound_colour;
use crate::error::Result;

/// Geometry as a request has it, and the parameters that it did not need.
pub(super) type Read = (RibGeometry, Parameters);

impl Reader {
    /// Carries out a request of this kind, or says that it is not.
    pub(super) fn geometry(&mut self, request: &mut Request) -> Result<bool> {
        let known = &self.declarations;
        let bases = Bases { bases: self.attributes.bases, steps: self.attributes.steps };
        let (geometry, parameters) = match request.name.as_str() {
            "Sphere" | "Cone" | "Cylinder" | "Hyperboloid" | "Paraboloid" | "Disk" | "Torus" => {
                quadrics::quadric(request, known)?
            }
            "Patch" => patches::patch(request, known, &bases)?,
            "PatchMesh" => patches::patch_mesh(request, known, &bases)?,
            "NuPatch" => patches::nu_patch(request, known)?,
            "Polygon" => polygons::polygon(request, known)?,
            "GeneralPolygon" => polygons::general_polygon(request, known)?,
            "PointsPolygons" => polygons::points_polygons(request, known)?,
            "PointsGeneralPolygons" => polygons::points_general_polygons(request, known)?,
            "SubdivisionMesh" | "HierarchicalSubdivisionMesh" => {
                subdivision::mesh(request, known, &mut self.warnings)?
            }
            "Curves" => curves::curves(request, known, &bases)?,
            "Basis" => {
                (self.attributes.bases, self.attributes.steps) = patches::basis(request)?;
                return Ok(true);
            }
            "TrimCurve" => {
                self.warnings.add(&request.place, "`TrimCurve`: surfaces are drawn without being trimmed");
                return Ok(true);
            }
            _ => return Ok(false),
        };
        self.draw_coloured(request, geometry, parameters)?;
        Ok(true)
    }

    /// A colour or an opacity among the parameters is that of the geometry, unless it differs within it.
    fn draw_coloured(
        &mut self,
        request: &Request,
        geometry: RibGeometry,
        mut parameters: Parameters,
    ) -> Result<()> {
        let outside = self.attributes.looks;
        if let Some(colour) = self.only(parameters.take("Cs"))? {
            self.attributes.looks.colour = Some(sound_colour(request, colour)?);
        }
        if let Some(opacity) = self.only(parameters.take("Os"))? {
            self.attributes.looks.opacity = Some(self.opacity(request, opacity)?);
        }
        let drawn = self.draw(request, geometry);
        self.attributes.looks = outside;
        self.leave(request, parameters);
        drawn
    }

    /// The value of a parameter that has a single one.
    fn only(&mut self, parameter: Option<Parameter>) -> Result<Option<[f64; 3]>> {
        let Some(parameter) = parameter else { return Ok(None) };
        let what =
            format!("{} that differs within geometry is not supported and ignored", quoted(&parameter.name));
        let (place, class) = (parameter.place.clone(), parameter.declaration.class);
        match (&parameter.values::<3>()?[..], class) {
            (&[only], _) => return Ok(Some(only)),
            (&[first, ..], Class::Constant) => return Ok(Some(first)),
            _ => self.warnings.add(&place, what),
        }
        Ok(None)
    }
}

/// The points of geometry, `P`.
pub(super) fn points(request: &Request, parameters: &mut Parameters) -> Result<Vec<[f64; 3]>> {
    match parameters.take("P") {
        Some(points) => points.values(),
        None => Err(request.wrong("it has no points", "give it the parameter \"P\": three numbers a point")),
    }
}

/// The points of geometry that may be rational: `P`, or `Pw`, which has coordinates multiplied by their weights.
pub(super) fn weighted_points(request: &Request, parameters: &mut Parameters) -> Result<Vec<[f64; 4]>> {
    let Some(weighted) = parameters.take("Pw") else {
        let points = points(request, parameters)?;
        return Ok(points.into_iter().map(|[x, y, z]| [x, y, z, 1.0]).collect());
    };
    let points: Vec<[f64; 4]> = weighted.values()?;
    let divided = points.iter().map(|&[x, y, z, w]| {
        let point = [x / w, y / w, z / w, w];
        let is_sound = w > 0.0 && point.iter().all(|number| number.abs() <= super::request::MAX_NUMBER);
        is_sound.then_some(point).ok_or_else(|| {
            let problem = format_args!("a point of `Pw` has the weight {w}");
            request.wrong(problem, "use weights above 0, and points that are not too far away")
        })
    });
    divided.collect()
}

/// Refuses another number of points.
pub(super) fn check_count(request: &Request, found: usize, expected: Option<usize>) -> Result<()> {
    if expected == Some(found) {
        return Ok(());
    }
    let expected = expected.map_or("more than fit".to_owned(), |expected| expected.to_string());
    let problem = format_args!("it has {found} points, and should have {expected}");
    Err(request.wrong(problem, "give it as many points as its other arguments say"))
}

#[cfg(test)]
mod tests {
    use crate::rib::tests::{read, wrong};

    #[test]
    fn a_colour_may_be_that_of_the_geometry() {
        let colours = |requests: &str| {
            let scene = read(requests);
            let colours: Vec<_> = scene.objects.iter().map(|object| object.colour[0]).collect();
            (colours, scene.warnings.len())
        };
        let corners = "\"P\" [0 0 0 1 0 0 0 1 0]";
        assert_eq!(
            colours(&format!("Color 0 0 0 Polygon {corners} \"constant color Cs\" [0.5 0 0] Disk 0 1 360")),
            (vec![0.5, 0.0], 0)
        );
        assert_eq!(colours(&format!("Polygon {corners} \"Cs\" [0 0 0 1 1 1 0 0 0]")), (vec![1.0], 1));
        assert!(wrong(&format!("Polygon {corners} \"Cs\" [0.5 0]")).contains("`Cs` has 2 numbers"));
    }

    #[test]
    fn parameters_that_are_not_used_are_warned_about() {
        let scene =
            read("Sphere 1 -1 1 360 \"varying float foo\" [1 2 3 4]\nSphere 1 -1 1 360 \"foo\" [1 2 3 4]");
        assert_eq!(scene.warnings, ["x.rib:1: parameter `foo` of `Sphere` is not used"]);
    }
}
