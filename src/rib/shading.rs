//! Requests that say how things look: colours, surfaces and lights.

use glam::{DAffine3, DVec3};

use super::model::{RibLight, RibLightKind, RibSurface};
use super::parameters::Parameters;
use super::place::quoted;
use super::reader::{Lamp, Reader};
use super::request::Request;
use super::state::BlockKind;
use super::view::{sound_colour, within};
use crate::error::Result;

impl RibLightKind {
    /// As it is when its space is moved.
    pub(super) fn moved(self, by: DAffine3) -> Self {
        match self {
            Self::Ambient => Self::Ambient,
            Self::Distant { to_light } => {
                Self::Distant { to_light: by.transform_vector3(to_light.into()).into() }
            }
            Self::Point { position } => Self::Point { position: by.transform_point3(position.into()).into() },
        }
    }
}

impl Reader {
    /// Carries out a request of this kind, or says that it is not.
    pub(super) fn shading(&mut self, request: &mut Request) -> Result<bool> {
        match request.name.as_str() {
            "Color" => {
                let colour = request.list("colour")?;
                self.attributes.looks.colour = Some(sound_colour(request, colour)?);
            }
            "Opacity" => {
                let channels = request.list("opacity")?;
                self.attributes.looks.opacity = Some(self.opacity(request, channels)?);
            }
            "Surface" => self.attributes.looks.surface = Some(self.surface(request)?),
            "LightSource" => self.light_source(request)?,
            "Illuminate" => self.illuminate(request)?,
            _ => return Ok(false),
        }
        request.end()?;
        Ok(true)
    }

    /// Here all colours are hidden alike.
    pub(super) fn opacity(&mut self, request: &Request, channels: [f64; 3]) -> Result<f64> {
        if !channels.iter().all(|channel| (0.0..=1.0).contains(channel)) {
            let [r, g, b] = channels;
            return Err(request.wrong(format_args!("its opacity is {r} {g} {b}"), "use values from 0 to 1"));
        }
        let [r, g, b] = channels;
        if r != g || g != b {
            self.warnings.add(&request.place, "an opacity that differs by colour is taken as its mean");
        }
        let mean = (r + g + b) / 3.0;
        // Less cannot be told from nothing.
        Ok(if mean == 0.0 {
            0.0
        } else if r == g && g == b {
            r.max(0.001)
        } else {
            mean.max(0.001)
        })
    }

    /// The standard shaders, by their parameters; others as `matte` is, unless they have parameters of the same names.
    fn surface(&mut self, request: &mut Request) -> Result<RibSurface> {
        let name = request.text("shader")?;
        let mut parameters = self.parameters(request)?;
        let (diffuse, specular, is_known) = match name.as_str() {
            "matte" => (1.0, 0.0, true),
            "plastic" => (0.5, 0.5, true),
            "defaultsurface" | "null" => (RibSurface::DEFAULT.diffuse, 0.0, true),
            "paintedplastic" => (0.5, 0.5, false),
            "metal" | "shinymetal" => (0.5, 1.0, false),
            _ => (1.0, 0.0, false),
        };
        if !is_known {
            let like = if specular > 0.0 { "plastic" } else { "matte" };
            let what = format!("surface {} is not supported and drawn as {like}", quoted(&name));
            self.warnings.add(&request.place, what);
        }
        let mut share = |name: &str, otherwise: f64| {
            let number = parameters.number(name)?.unwrap_or(otherwise);
            within(request, name, number, 0.0, 1.0e3)
        };
        let surface = RibSurface {
            diffuse: share("Kd", diffuse)?,
            specular: share("Ks", specular)?,
            roughness: share("roughness", RibSurface::DEFAULT.roughness)?,
        };
        self.check_ambient(request, &mut parameters, surface)?;
        self.leave(request, parameters);
        Ok(surface)
    }

    fn check_ambient(
        &mut self,
        request: &Request,
        parameters: &mut Parameters,
        surface: RibSurface,
    ) -> Result<()> {
        if parameters.number("Ka")?.is_some_and(|share| share != surface.diffuse) {
            let what = "`Ka` is not used: ambient light is reflected as diffuse light is, by `Kd`";
            self.warnings.add(&request.place, what);
        }
        Ok(())
    }

    fn light_source(&mut self, request: &mut Request) -> Result<()> {
        let name = request.text("shader")?;
        let handle = if request.has_more() { request.handle()? } else { String::new() };
        let mut parameters = self.parameters(request)?;
        let Some(kind) = self.light_kind(request, &name, &mut parameters)? else { return Ok(()) };
        let intensity = parameters.number("intensity")?.unwrap_or(1.0);
        let intensity = within(request, "intensity", intensity, 0.0, 1.0e6)?;
        let colour = parameters.list("lightcolor")?.unwrap_or([1.0; 3]);
        let colour = sound_colour(request, colour)?.map(|channel| channel * intensity);
        self.leave(request, parameters);
        if matches!(kind, RibLightKind::Point { .. }) {
            let what = "a point light is everywhere as bright as it is in the middle of the scene";
            self.warnings.add(&request.place, what);
        }
        let kind = kind.moved(self.attributes.transform);
        let light = RibLight { kind, colour, place: request.place.clone() };
        self.lamps.push(Lamp { light, handle, is_on: true });
        Ok(())
    }

    fn light_kind(
        &mut self,
        request: &Request,
        name: &str,
        parameters: &mut Parameters,
    ) -> Result<Option<RibLightKind>> {
        Ok(Some(match name {
            "ambientlight" => RibLightKind::Ambient,
            "distantlight" => distant(request, parameters)?,
            "pointlight" => point(parameters)?,
            "spotlight" => {
                self.warnings.add(&request.place, "a `spotlight` shines in all directions here");
                point(parameters)?
            }
            _ => {
                let what = format!("light {} is not supported and ignored", quoted(name));
                self.warnings.add(&request.place, what);
                return Ok(None);
            }
        }))
    }

    /// Lights are on or off for all of the scene.
    fn illuminate(&mut self, request: &mut Request) -> Result<()> {
        let handle = request.handle()?;
        let is_on = request.number("switch")? != 0.0;
        let is_global = self.parts.is_empty() && self.blocks.iter().all(|block| is_global(block.kind));
        for lamp in self.lamps.iter_mut().filter(|lamp| lamp.handle == handle && lamp.is_on != is_on) {
            if is_global {
                lamp.is_on = is_on;
            } else {
                let what = "`Illuminate` for some of the geometry is ignored: lights shine on all of it";
                self.warnings.add(&request.place, what);
            }
        }
        Ok(())
    }
}

/// Is what stands in such a block said of the whole scene?
const fn is_global(kind: BlockKind) -> bool {
    matches!(kind, BlockKind::Frame | BlockKind::World | BlockKind::Transform)
}

/// It shines from one point towards another one, everywhere.
fn distant(request: &Request, parameters: &mut Parameters) -> Result<RibLightKind> {
    let from = DVec3::from(parameters.list("from")?.unwrap_or([0.0; 3]));
    let to = DVec3::from(parameters.list("to")?.unwrap_or([0.0, 0.0, 1.0]));
    if (from - to).try_normalize().is_none() {
        return Err(request.wrong("it shines from a point to the same one", "move one of `from` and `to`"));
    }
    Ok(RibLightKind::Distant { to_light: (from - to).into() })
}

fn point(parameters: &mut Parameters) -> Result<RibLightKind> {
    Ok(RibLightKind::Point { position: parameters.list("from")?.unwrap_or([0.0; 3]) })
}

#[cfg(test)]
mod tests {
    use crate::rib::tests::{read, wrong};
    use crate::rib::{RibLightKind, RibObject, RibSurface};

    fn object(requests: &str) -> RibObject {
        read(&format!("{requests}\nSphere 1 -1 1 360")).objects.remove(0)
    }

    #[test]
    fn looks_are_those_set_last_in_the_same_block() {
        let scene = read(
            "Color [1 0 0] AttributeBegin Color 0 1 0 Opacity 0.5 0.5 0.5 Sphere 1 -1 1 360 AttributeEnd\n\
             Sphere 1 -1 1 360 TransformBegin Color 0 0 1 TransformEnd Sphere 1 -1 1 360",
        );
        let looks: Vec<_> = scene.objects.iter().map(|object| (object.colour, object.opacity)).collect();
        assert_eq!(looks, [([0.0, 1.0, 0.0], 0.5), ([1.0, 0.0, 0.0], 1.0), ([0.0, 0.0, 1.0], 1.0)]);
        assert_eq!(object("").colour, [1.0; 3]);
        assert!(wrong("Color 1 -1 0").contains("its colour is 1 -1 0"));
        assert!(wrong("Color 1").contains("has 1 numbers"));
        assert!(wrong("Opacity 1 1 2").contains("opacity is 1 1 2"));
    }

    #[test]
    fn what_cannot_be_seen_is_left_out() {
        let scene = read("Sphere 1 -1 1 360 Opacity 0 0 0 Sphere 1 -1 1 360");
        assert_eq!((scene.objects.len(), scene.warnings.len()), (1, 1));
    }

    #[test]
    fn surfaces_have_the_parameters_of_the_standard_shaders() {
        let surface = |requests: &str| object(requests).surface;
        let expected = |diffuse, specular, roughness| RibSurface { diffuse, specular, roughness };
        assert_eq!(surface(""), expected(0.8, 0.0, 0.1));
        assert_eq!(surface("Surface \"matte\""), expected(1.0, 0.0, 0.1));
        assert_eq!(surface("Surface \"plastic\" \"Ks\" 0.25"), expected(0.5, 0.25, 0.1));
        assert_eq!(
            surface("Surface \"plastic\" \"uniform float roughness\" [0.02]"),
            expected(0.5, 0.5, 0.02)
        );
        assert_eq!(
            surface("Declare \"Kd\" \"float\" Surface \"matte\" \"Kd\" [0.7]"),
            expected(0.7, 0.0, 0.1)
        );
        assert_eq!(surface("Surface \"mine\" \"Ks\" [0.5]"), expected(1.0, 0.5, 0.1));
        assert!(wrong("Surface \"matte\" \"Kd\" [1 2]").contains("`Kd` has 2 numbers"));
        assert!(wrong("Surface \"matte\" \"Kd\" \"x\"").contains("not numbers"));
        assert!(wrong("Surface \"matte\" \"Kd\"").contains("the value of `Kd` is missing"));
    }

    #[test]
    fn surfaces_that_are_unknown_are_warned_about_once() {
        let scene = read("Surface \"mine\" Surface \"mine\" Surface \"matte\" \"Ka\" 0.5 Sphere 1 -1 1 360");
        let [first, second] = &scene.warnings[..] else { panic!("{:?}", scene.warnings) };
        assert!(first.contains("surface `mine`") && second.contains("`Ka`"));
    }

    #[test]
    fn lights_are_placed_where_they_stand() {
        let scene = read(
            "WorldBegin LightSource \"ambientlight\" 1 \"intensity\" 0.25\n\
             Translate 1 2 3 LightSource \"distantlight\" 2 \"from\" [0 5 0] \"to\" [0 0 0] \"lightcolor\" [1 0.5 0]\n\
             LightSource \"pointlight\" \"lamp\" \"intensity\" 20 \"point from\" [1 0 0]\n\
             Sphere 1 -1 1 360 WorldEnd",
        );
        let lights: Vec<_> =
            scene.lights.iter().map(|light| (light.kind, light.colour, light.place.line)).collect();
        assert_eq!(
            lights,
            [
                (RibLightKind::Ambient, [0.25; 3], 1),
                (RibLightKind::Distant { to_light: [0.0, 5.0, 0.0] }, [1.0, 0.5, 0.0], 2),
                (RibLightKind::Point { position: [2.0, 2.0, 3.0] }, [20.0; 3], 3),
            ]
        );
        assert!(wrong("LightSource \"distantlight\" 1 \"to\" [0 0 0]").contains("same one"));
    }

    #[test]
    fn lights_are_switched_for_the_whole_scene() {
        let lights = "LightSource \"ambientlight\" 1 LightSource \"distantlight\" \"sun\"";
        let scene =
            read(&format!("{lights} Illuminate 1 0 Illuminate \"sun\" 0 Illuminate \"sun\" 1 Disk 0 1 360"));
        assert_eq!((scene.lights.len(), scene.warnings.len()), (1, 0));
        let some = "AttributeBegin Illuminate 1 0 Disk 0 1 360 AttributeEnd Illuminate 1 1";
        let scene = read(&format!("{lights} {some}"));
        assert_eq!((scene.lights.len(), scene.warnings.len()), (2, 1));
    }
}
