//! Subdivision meshes and their tags (RenderMan Interface 3.2, section 5.4).

use super::geometry::{Read, points};
use super::model::RibGeometry;
use super::parameters::{Declarations, Parameters};
use super::place::quoted;
use super::polygons::Mesh;
use super::request::{Request, whole};
use super::warnings::Warnings;
use crate::cage::{Boundary, Cage, Crease};
use crate::error::Result;

/// `SubdivisionMesh` and its younger form, which has strings among the arguments of tags.
pub(super) fn mesh(request: &mut Request, known: &Declarations, warnings: &mut Warnings) -> Result<Read> {
    let scheme = request.text("scheme")?;
    if scheme != "catmull-clark" {
        let problem = format_args!("the scheme {} is not supported", quoted(&scheme));
        return Err(request.wrong(problem, "use \"catmull-clark\""));
    }
    let face_sizes = request.indices("numbers of points")?;
    let corners = request.indices("points of faces")?;
    let tags = tags(request)?;
    let mut parameters = Parameters::of(request, known)?;
    let positions = points(request, &mut parameters)?;
    let mut cage = Mesh { face_sizes, corners, positions }.cage(request, &mut parameters)?;
    // Unless a tag says otherwise.
    cage.boundary = Boundary::None;
    for tag in &tags {
        tag.apply(request, &mut cage, warnings)?;
    }
    Ok((RibGeometry::Subdivision(cage), parameters))
}

/// A tag and its arguments.
#[derive(Debug)]
struct Tag {
    name: String,
    whole: Vec<f64>,
    floats: Vec<f64>,
}

/// Names, numbers of arguments of each kind, and the arguments of all tags; or nothing.
fn tags(request: &mut Request) -> Result<Vec<Tag>> {
    if !request.has_array() {
        return Ok(Vec::new());
    }
    let names = request.texts("tags")?;
    let counts = request.indices("numbers of tags' arguments")?;
    let (whole, floats) = (request.numbers("whole arguments")?, request.numbers("other arguments")?);
    let texts = if request.has_array() { request.texts("arguments that are strings")?.len() } else { 0 };
    let kinds = if counts.len() == 3 * names.len() { 3 } else { 2 };
    if counts.len() != kinds * names.len() {
        let problem = format_args!("it has {} tags and {} numbers of arguments", names.len(), counts.len());
        return Err(request.wrong(problem, "give two numbers for each tag, or three for each"));
    }
    let sum =
        |kind: usize| counts.iter().skip(kind).step_by(kinds).map(|&count| u64::from(count)).sum::<u64>();
    let found = [whole.len() as u64, floats.len() as u64, texts as u64];
    let claimed = [sum(0), sum(1), if kinds == 3 { sum(2) } else { 0 }];
    if found != claimed {
        let problem = format_args!("its tags have {found:?} arguments, and should have {claimed:?}");
        return Err(request.wrong(problem, "let the numbers of arguments be those of the lists that follow"));
    }
    let (mut whole, mut floats) = (whole.into_iter(), floats.into_iter());
    let each = names.into_iter().zip(counts.chunks_exact(kinds)).map(|(name, counts)| Tag {
        name,
        whole: whole.by_ref().take(counts[0] as usize).collect(),
        floats: floats.by_ref().take(counts[1] as usize).collect(),
    });
    Ok(each.collect())
}

impl Tag {
    fn apply(&self, request: &Request, cage: &mut Cage, warnings: &mut Warnings) -> Result<()> {
        match self.name.as_str() {
            "crease" => {
                let vertices = self.indices(request, cage.positions.len())?;
                for (pair, sharpness) in vertices.windows(2).zip(self.sharpness(request, vertices.len() - 1)?)
                {
                    cage.creases.push(Crease { vertices: [pair[0], pair[1]], sharpness });
                }
            }
            "corner" => {
                let vertices = self.indices(request, cage.positions.len())?;
                let sharpness = self.sharpness(request, vertices.len())?;
                cage.sharp_vertices.extend(vertices.into_iter().zip(sharpness));
            }
            "hole" => cage.holes.extend(self.indices(request, cage.face_sizes.len())?),
            "interpolateboundary" => cage.boundary = self.boundary(request)?,
            _ => {
                let what = format!(
                    "tag {} of {} is not supported and ignored",
                    quoted(&self.name),
                    quoted(&request.name)
                );
                warnings.add(&request.place, what);
            }
        }
        Ok(())
    }

    /// Its whole arguments, one or more, as indices below a number.
    fn indices(&self, request: &Request, count: usize) -> Result<Vec<u32>> {
        let below = |&number: &f64| whole(number).filter(|&index| (index as usize) < count);
        let indices: Option<Vec<u32>> = self.whole.iter().map(below).collect();
        indices.filter(|indices| !indices.is_empty()).ok_or_else(|| {
            let odd = self.whole.iter().find(|number| below(number).is_none());
            let name = quoted(&self.name);
            let problem = match odd {
                Some(odd) => format!("tag {name} names {odd}, and there are {count}"),
                None => format!("tag {name} names nothing"),
            };
            request.wrong(problem, "points and faces are counted from 0")
        })
    }

    /// One for each, or one for all.
    fn sharpness(&self, request: &Request, count: usize) -> Result<Vec<f32>> {
        let wrong =
            |problem: &str| request.wrong(format_args!("tag {}: {problem}", quoted(&self.name)), SHARPNESS);
        if self.floats.iter().any(|&sharpness| sharpness < 0.0) {
            return Err(wrong("a sharpness is negative"));
        }
        match &self.floats[..] {
            &[only] => Ok(vec![only as f32; count]),
            each if each.len() == count => Ok(each.iter().map(|&sharpness| sharpness as f32).collect()),
            _ => Err(wrong("there are more or fewer numbers than sharp edges or vertices")),
        }
    }

    /// As OpenSubdiv and RenderMan number the rules; without a number it is what it was before there were several.
    fn boundary(&self, request: &Request) -> Result<Boundary> {
        match self.whole.first().copied() {
            Some(0.0) => Ok(Boundary::None),
            None | Some(1.0) => Ok(Boundary::EdgeAndCorner),
            Some(2.0) => Ok(Boundary::EdgeOnly),
            Some(other) => {
                let problem = format_args!("tag `interpolateboundary` is {other}");
                Err(request.wrong(problem, "use 0 (none), 1 (edges and corners) or 2 (edges)"))
            }
        }
    }
}

const SHARPNESS: &str = "give one sharpness from 0 for all, or one for each edge or vertex";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{geometry, read, wrong};

    const GRID: &str = "[4 4] [0 1 4 3 1 2 5 4]";
    const POINTS: &str = "\"P\" [0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0]";

    fn request(tags: &str) -> String {
        format!("SubdivisionMesh \"catmull-clark\" {GRID} {tags} {POINTS}")
    }

    fn cage(tags: &str) -> Cage {
        match geometry(&request(tags)) {
            RibGeometry::Subdivision(cage) => cage,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn meshes_need_no_tags() {
        let plain = cage("");
        assert_eq!((plain.face_sizes.len(), plain.corners.len(), plain.positions.len()), (2, 8, 6));
        assert_eq!(plain.boundary, Boundary::None);
        assert_eq!(cage("[] [] [] []"), plain);
    }

    #[test]
    fn tags_are_read_in_both_forms() {
        let names = "[\"crease\" \"crease\" \"corner\" \"hole\" \"interpolateboundary\"]";
        let arguments = "[0 1 2  1 4  0 5  1  2] [2.5  1 10  3 4]";
        let short = cage(&format!("{names} [3 1 2 1 2 2 1 0 1 0] [0 1 2  1 4  0 5  1  2] [2.5  10  3 4]"));
        let crease = |a, b, sharpness| Crease { vertices: [a, b], sharpness };
        assert_eq!(short.creases, [crease(0, 1, 2.5), crease(1, 2, 2.5), crease(1, 4, 10.0)]);
        assert_eq!(short.sharp_vertices, [(0, 3.0), (5, 4.0)]);
        assert_eq!((&short.holes[..], short.boundary), (&[1][..], Boundary::EdgeOnly));
        let long = "[3 1 0 2 1 0 2 2 0 1 0 0 1 0 0] [0 1 2  1 4  0 5  1  2] [2.5  10  3 4] []";
        assert_eq!(cage(&format!("{names} {long}")), short);
        assert!(wrong(&request(&format!("{names} [3 1 2 1 2 2 1 0 1 0] {arguments}"))).contains("[9, 5, 0]"));
    }

    #[test]
    fn boundaries_are_numbered() {
        for (tag, expected) in [
            ("[0 0] [] []", Boundary::EdgeAndCorner),
            ("[1 0] [0] []", Boundary::None),
            ("[1 0] [1] []", Boundary::EdgeAndCorner),
            ("[1 0] [2] []", Boundary::EdgeOnly),
        ] {
            assert_eq!(cage(&format!("[\"interpolateboundary\"] {tag}")).boundary, expected, "{tag}");
        }
        assert!(wrong(&request("[\"interpolateboundary\"] [1 0] [3] []")).contains("is 3"));
    }

    #[test]
    fn tags_that_are_not_whole_are_refused() {
        for (tags, part) in [
            ("[\"crease\"] [2 1] [0] [1]", "[1, 1, 0] arguments, and should have [2, 1, 0]"),
            ("[\"crease\"] [2] [0 1] [1]", "1 tags and 1 numbers"),
            ("[\"crease\"] [2 1] [0 6] [1]", "names 6, and there are 6"),
            ("[\"crease\"] [2 1] [0 -1] [1]", "names -1"),
            ("[\"crease\"] [0 1] [] [1]", "names nothing"),
            ("[\"crease\"] [3 3] [0 1 2] [1 2 3]", "more or fewer numbers"),
            ("[\"corner\"] [1 1] [0] [-1]", "negative"),
            ("[\"hole\"] [1 0] [2] []", "names 2, and there are 2"),
        ] {
            assert!(wrong(&request(tags)).contains(part), "{}", wrong(&request(tags)));
        }
        let loops = format!("SubdivisionMesh \"loop\" {GRID} {POINTS}");
        assert!(wrong(&loops).contains("scheme `loop` is not supported"));
    }

    #[test]
    fn tags_that_are_unknown_are_warned_about() {
        let scene = read(&request("[\"facevaryinginterpolateboundary\" \"smooth\"] [1 0 0 0] [1] []"));
        assert_eq!(scene.warnings.len(), 2);
        let crease = cage("[\"creasemethod\" \"crease\"] [0 0 1 2 1 0] [0 1] [3] [\"chaikin\"]");
        assert_eq!(crease.creases.len(), 1);
    }
}
