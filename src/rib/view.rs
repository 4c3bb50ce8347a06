//! Requests that say how a scene is seen: camera, image and what is behind everything.

use glam::{DAffine3, DVec3};

use super::camera::{RibCamera, RibLens};
use super::place::quoted;
use super::reader::Reader;
use super::request::Request;
use crate::error::Result;

/// Numbers from here on are as good as infinite.
const INFINITE: f64 = 1.0e30;

/// What is set about the camera.
#[derive(Clone, Debug, Default)]
pub(super) struct View {
    /// Degrees; none as long as the projection is orthographic, as it is at first.
    fov: Option<f64>,
    resolution: Option<[usize; 2]>,
    image_aspect: Option<f64>,
    frame_aspect: Option<f64>,
    half_height: Option<f64>,
    near: Option<f64>,
    lens: Option<RibLens>,
    /// What is done to the image: stretched, mirrored or turned.
    screen: DAffine3,
}

impl View {
    /// The camera, if it is one of perspective.
    pub(super) fn camera(&self, to_camera: DAffine3) -> Option<RibCamera> {
        let from_world = self.screen * to_camera;
        let Self { resolution, half_height, near, lens, .. } = *self;
        let aspect = self.frame_aspect.or(self.image_aspect);
        self.fov.map(|fov| RibCamera { from_world, fov, aspect, resolution, half_height, near, lens })
    }
}

impl Reader {
    /// Carries out a request of this kind, or says that it is not.
    pub(super) fn view(&mut self, request: &mut Request) -> Result<bool> {
        match request.name.as_str() {
            "Projection" => self.projection(request)?,
            "Format" => self.format(request)?,
            "FrameAspectRatio" => {
                let aspect = request.number("aspect")?;
                self.view.frame_aspect = Some(within(request, "aspect", aspect, 1.0e-3, 1.0e3)?);
            }
            "ScreenWindow" => self.screen_window(request)?,
            "Clipping" => self.clipping(request)?,
            "DepthOfField" => self.depth_of_field(request)?,
            "Imager" => self.imager(request)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    fn projection(&mut self, request: &mut Request) -> Result<()> {
        self.begin_camera(request);
        let kind = request.text("kind")?;
        let mut parameters = self.parameters(request)?;
        match kind.as_str() {
            "perspective" => {
                let fov = parameters.number("fov")?.unwrap_or(90.0);
                self.view.fov = Some(within(request, "fov", fov, 0.001, 179.0)?);
            }
            "orthographic" => {
                let remedy = "use \"perspective\" with a small fov, from farther away";
                return Err(request.wrong("an orthographic projection is not supported", remedy));
            }
            _ => {
                let what = format!("projection {} is not supported and ignored", quoted(&kind));
                self.warnings.add(&request.place, what);
                return Ok(());
            }
        }
        self.leave(request, parameters);
        Ok(())
    }

    /// What stands before the projection happens to the image, and camera space begins behind it.
    fn begin_camera(&mut self, request: &Request) {
        let screen = std::mem::take(&mut self.attributes.transform);
        let is_flat = screen.translation == DVec3::ZERO
            && screen.matrix3.row(2) == DVec3::Z
            && screen.matrix3.col(2) == DVec3::Z;
        if is_flat {
            self.view.screen = screen;
        } else {
            let what =
                "transforms before `Projection` that move the image, or z, are not supported and ignored";
            self.warnings.add(&request.place, what);
        }
    }

    /// Width, height and aspect of a pixel; what is negative is left as it is.
    fn format(&mut self, request: &mut Request) -> Result<()> {
        let [width, height, pixel] = request.list("width, height and aspect of a pixel")?;
        request.end()?;
        if width >= 1.0 && height >= 1.0 {
            self.view.resolution = Some([width as usize, height as usize]);
            let pixel = if pixel > 0.0 { pixel } else { 1.0 };
            self.view.image_aspect = Some(within(request, "aspect", width / height * pixel, 1.0e-3, 1.0e3)?);
        }
        Ok(())
    }

    fn screen_window(&mut self, request: &mut Request) -> Result<()> {
        let [left, right, bottom, top] = request.list("window")?;
        request.end()?;
        let near = |a: f64, b: f64| (a + b).abs() <= 1.0e-6 * (a - b).abs();
        if left < right && bottom < top && near(left, right) && near(bottom, top) {
            self.view.half_height = Some(within(request, "height", top, 1.0e-3, 1.0e3)?);
        } else {
            let what = "a window that is not around the middle of the screen is not supported and ignored";
            self.warnings.add(&request.place, what);
        }
        Ok(())
    }

    fn clipping(&mut self, request: &mut Request) -> Result<()> {
        let (near, far) = (request.number("near distance")?, request.number("far distance")?);
        request.end()?;
        self.view.near = Some(within(request, "near distance", near, 0.0, 1.0e12)?);
        if far < INFINITE {
            let what = "`Clipping`: what is farther than its far distance is drawn all the same";
            self.warnings.add(&request.place, what);
        }
        Ok(())
    }

    /// Without arguments, or with an infinite f-stop, all distances are sharp.
    fn depth_of_field(&mut self, request: &mut Request) -> Result<()> {
        self.view.lens = None;
        if !request.has_more() {
            return Ok(());
        }
        let fstop = request.number("f-stop")?;
        if fstop >= INFINITE || !request.has_more() {
            return Ok(());
        }
        let (focal_length, focus) = (request.number("focal length")?, request.number("focal distance")?);
        request.end()?;
        let fstop = within(request, "f-stop", fstop, 1.0e-6, 1.0e9)?;
        let focal_length = within(request, "focal length", focal_length, 1.0e-9, 1.0e9)?;
        let focus = within(request, "focal distance", focus, 1.0e-6, 1.0e12)?;
        self.view.lens = Some(RibLens { fstop, focal_length, focus });
        Ok(())
    }

    /// Of imagers only the one that fills the background.
    fn imager(&mut self, request: &mut Request) -> Result<()> {
        let kind = request.text("kind")?;
        let mut parameters = self.parameters(request)?;
        let colour = match parameters.list("bgcolor")? {
            None => parameters.list("background")?,
            found => found,
        };
        match (kind.as_str(), colour) {
            ("background", Some(colour)) => self.scene.background = Some(sound_colour(request, colour)?),
            ("background", None) => {}
            _ => {
                let what = format!("imager {} is not supported and ignored", quoted(&kind));
                self.warnings.add(&request.place, what);
                return Ok(());
            }
        }
        self.leave(request, parameters);
        Ok(())
    }
}

/// The number, unless it is out of range.
pub(super) fn within(request: &Request, what: &str, number: f64, least: f64, most: f64) -> Result<f64> {
    if number >= least && number <= most {
        return Ok(number);
    }
    let remedy = format!("choose a {what} from {least:?} to {most:?}");
    Err(request.wrong(format_args!("its {what} is {number}"), remedy))
}

/// The colour, unless it is none.
pub(super) fn sound_colour(request: &Request, colour: [f64; 3]) -> Result<[f64; 3]> {
    if colour.iter().all(|channel| (0.0..=1.0e6).contains(channel)) {
        return Ok(colour);
    }
    let [r, g, b] = colour;
    Err(request.wrong(format_args!("its colour is {r} {g} {b}"), "use linear values from 0 to 1e6"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rib::tests::{read, wrong};

    const BALL: &str = "WorldBegin\nSphere 1 -1 1 360\nWorldEnd";

    fn camera(requests: &str) -> RibCamera {
        let scene = read(&format!("Projection \"perspective\" \"fov\" [40]\n{requests}\n{BALL}"));
        scene.camera.expect("a camera")
    }

    #[test]
    fn the_camera_is_where_the_world_begins() {
        let camera = camera("Format 640 480 1 Clipping 0.1 1e38 Translate 0 0 5 DepthOfField 2.8 0.05 4");
        assert_eq!(camera.from_world.translation, glam::DVec3::new(0.0, 0.0, 5.0));
        assert_eq!((camera.fov, camera.resolution), (40.0, Some([640, 480])));
        assert_eq!((camera.aspect, camera.near), (Some(640.0 / 480.0), Some(0.1)));
        assert_eq!(camera.lens, Some(RibLens { fstop: 2.8, focal_length: 0.05, focus: 4.0 }));
        assert_eq!(camera.camera().fov, camera.vertical_fov());
    }

    #[test]
    fn transforms_before_the_projection_happen_to_the_image() {
        let camera = |before: &str| {
            let scene = read(&format!("{before} Projection \"perspective\" Translate 0 0 5 {BALL}"));
            (scene.camera.expect("a camera").from_world, scene.warnings.len())
        };
        let at = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(camera("Scale -1 1 1").0.transform_point3(at), DVec3::new(-1.0, 2.0, 8.0));
        assert_eq!(camera("Translate 0 0 1"), camera("Rotate 90 1 0 0"));
        assert_eq!(camera("Translate 0 0 1"), (DAffine3::from_translation(DVec3::new(0.0, 0.0, 5.0)), 1));
    }

    #[test]
    fn frames_may_be_upright_and_windows_smaller() {
        assert_eq!(camera("Format 100 200 2").aspect, Some(1.0));
        assert_eq!(camera("Format 100 200 1 FrameAspectRatio 1.5").aspect, Some(1.5));
        assert_eq!(camera("ScreenWindow -2 2 -1 1").half_height, Some(1.0));
        assert_eq!(camera("ScreenWindow 0 2 -1 1").half_height, None);
        assert_eq!(camera("Format -1 -1 -1").aspect, None);
    }

    #[test]
    fn things_before_the_world_are_placed_relative_to_the_camera() {
        let scene = read(&format!(
            "Projection \"perspective\" Translate 0 0 5 LightSource \"pointlight\" 1 \"from\" [0 0 0]\n\
             Identity LightSource \"pointlight\" 2 \"from\" [0 0 0] Translate 0 0 5\n{BALL}"
        ));
        let position = |index: usize| match scene.lights[index].kind {
            crate::rib::RibLightKind::Point { position } => position,
            other => panic!("{other:?}"),
        };
        assert_eq!((position(0), position(1)), ([0.0; 3], [0.0, 0.0, -5.0]));
    }

    #[test]
    fn a_projection_that_is_not_of_perspective_is_no_camera() {
        let scene = read(BALL);
        assert_eq!(scene.camera, None);
        assert!(scene.warnings[0].contains("orthographic"), "{:?}", scene.warnings);
        assert!(read("Sphere 1 -1 1 360").warnings.is_empty());
        assert!(wrong("\nProjection \"orthographic\"").starts_with("x.rib:2: `Projection`: an orthographic"));
        assert!(wrong("Projection \"perspective\" \"fov\" 180").contains("fov is 180"));
    }

    #[test]
    fn the_background_is_that_of_the_imager() {
        let background = |requests: &str| read(&format!("{requests} {BALL}")).background;
        assert_eq!(background(""), None);
        assert_eq!(
            background("Imager \"background\" \"color bgcolor\" [0.1 0.2 0.3]"),
            Some([0.1, 0.2, 0.3])
        );
        assert_eq!(background("Imager \"background\" \"background\" [0.1 0.2 0.3]"), Some([0.1, 0.2, 0.3]));
        assert!(wrong("Imager \"background\" \"bgcolor\" [0 0 -1]").contains("colour is 0 0 -1"));
    }
}
