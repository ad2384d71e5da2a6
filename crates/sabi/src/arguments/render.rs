//! Arguments of `sabi render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use sabi_engine::rendering::Turns;
use sabi_view::{
    Background, Light, LightPlace, Lines, STUDIO_ENVIRONMENT_STRENGTH, STUDIO_LIGHTS, USUAL_BLOOM, ViewTransform,
    Viewpoint,
};

use super::{EvaluationArguments, SubjectArguments};

/// Arguments of `sabi render`.
#[derive(Debug, Args)]
#[command(
    allow_negative_numbers = true,
    before_help = "\
Examples:
  sabi render graph.sabi --mesh model.glb -o picture.png
  sabi render graph.sabi --mesh model.glb -o picture.png --size 1920x1080 --environment low_sun --rotate 90
  sabi render graph.sabi --mesh model.glb -o close.png --displace --camera 40,20,0.4
  sabi render graph.sabi --mesh model.glb -o edges.png --view node:edges --camera 60,15
  sabi render graph.sabi --mesh model.glb -o turn.png --turntable 48 --transparent"
)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    pub(crate) subject: SubjectArguments,
    #[command(flatten)]
    pub(crate) evaluation: EvaluationArguments,
    /// Picture to write: a .png, or an .exr of the material's light, linear and exposed but not transformed; frames of a turntable are numbered after it
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Size of the picture, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = picture_size, help_heading = "Picture")]
    pub(crate) size: [u32; 2],
    /// Texels along a side of the maps, 16 to 8192; if it is not given, as many as give each pixel of the picture about one, a power
    /// of two from 256 to 4096. A picture with fewer than half a texel for a pixel is warned of
    #[arg(long, value_name = "N",
          value_parser = clap::value_parser!(u32).range(16..=8192), help_heading = "Picture")]
    pub(crate) texels: Option<u32>,
    /// Light from all around: studio, overcast, low_sun, interior, softboxes, or an .hdr or .exr file
    #[arg(long, value_name = "NAME|FILE", default_value = "studio", help_heading = "Light")]
    pub(crate) environment: String,
    /// Turn the environment, degrees
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = finite, help_heading = "Light")]
    pub(crate) rotate: f32,
    /// Strength of the environment: 0.6 beside the studio's lights and 1 otherwise, if it is not given
    #[arg(long, value_name = "FACTOR", value_parser = strength, help_heading = "Light")]
    pub(crate) environment_strength: Option<f32>,
    /// Distant light in place of the studio's key and rim light, which turn with the camera: its direction in degrees and its
    /// strength; up to four
    #[arg(long, value_name = "YAW,PITCH[,STRENGTH]", value_parser = light, allow_hyphen_values = true,
          help_heading = "Light")]
    pub(crate) light: Vec<Light>,
    /// Draw in the environment's light alone
    #[arg(long, conflicts_with = "light", help_heading = "Light")]
    pub(crate) no_lights: bool,
    /// Leave out the shade of the model on the ground
    #[arg(long, help_heading = "Picture")]
    pub(crate) no_ground: bool,
    /// Exposure, stops from -32 to 32
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, value_parser = stops, help_heading = "Light")]
    pub(crate) exposure: f32,
    /// Glow around highlights and emission: the share of the light above white that spreads, 0 to 1. It never changes the
    /// alpha of a picture, and an .exr has none
    #[arg(long, value_name = "SHARE", default_value_t = USUAL_BLOOM, value_parser = share, help_heading = "Light")]
    pub(crate) bloom: f32,
    /// Transform from light to display colors
    #[arg(long, value_enum, default_value_t = TransformChoice::Neutral, help_heading = "Light")]
    pub(crate) transform: TransformChoice,
    /// Place of the camera: front, three-quarter, left, right, back, top, bottom, or degrees and a multiple of the distance
    #[arg(
        long,
        allow_hyphen_values = true,
        value_name = "NAME|YAW,PITCH[,DISTANCE]",
        default_value = "three-quarter",
        help_heading = "Picture"
    )]
    pub(crate) camera: Viewpoint,
    /// Point to look at in place of the middle of the model: right, up and towards the front from its middle, in shares of its
    /// largest side
    #[arg(long, allow_hyphen_values = true, value_name = "X,Y,Z", value_parser = place, help_heading = "Picture")]
    pub(crate) target: Option<[f32; 3]>,
    /// Draw without perspective
    #[arg(long, help_heading = "Picture")]
    pub(crate) orthographic: bool,
    /// View to show: material, a channel such as roughness, checker, density, facing, clay, or a node's result
    #[arg(
        long,
        value_name = "VIEW|node:ID[.PORT]",
        default_value = "material",
        help_heading = "Picture"
    )]
    pub(crate) view: String,
    /// Follow heights, so that they hide one another and throw shadows
    #[arg(long, help_heading = "Picture")]
    pub(crate) relief: bool,
    /// Draw a finer copy of the model that heights displace, outline and all; --relief then does nothing. So many triangles at
    /// most: 2000000 if none are given, 500000 on a software adapter
    #[arg(long, value_name = "TRIANGLES", num_args = 0..=1, require_equals = true,
          value_parser = clap::value_parser!(u32).range(1..=20_000_000), help_heading = "Picture")]
    pub(crate) displace: Option<Option<u32>>,
    /// Lines over the model, lifted with it where it is displaced; may be repeated
    #[arg(long, value_enum, help_heading = "Picture")]
    pub(crate) lines: Vec<LinesChoice>,
    /// Background
    #[arg(long, value_enum, default_value_t = BackgroundChoice::Studio, help_heading = "Picture")]
    pub(crate) background: BackgroundChoice,
    /// Leave the background transparent
    #[arg(long, help_heading = "Picture")]
    pub(crate) transparent: bool,
    /// Samples a pixel: more make edges cleaner
    #[arg(long, value_name = "N", default_value_t = 16,
          value_parser = clap::value_parser!(u32).range(1..=4096), help_heading = "Picture")]
    pub(crate) samples: u32,
    /// Write this many frames around the model
    #[arg(long, value_name = "FRAMES", value_parser = clap::value_parser!(u32).range(1..=9999), help_heading = "Picture")]
    pub(crate) turntable: Option<u32>,
    /// Object that turns in the frames of a turntable
    #[arg(long, value_enum, default_value_t = TurnChoice::Camera, help_heading = "Picture")]
    pub(crate) turn: TurnChoice,
}

impl RenderArguments {
    /// Texels along a side of the maps until the model is loaded, if none are given.
    pub(crate) const FIRST_TEXELS: u32 = 256;

    /// Factor of the environment's light.
    pub(crate) fn environment_strength(&self) -> f32 {
        let has_studio_lights = !self.no_lights && self.light.is_empty();
        let usual = if has_studio_lights {
            STUDIO_ENVIRONMENT_STRENGTH
        } else {
            1.0
        };
        self.environment_strength.unwrap_or(usual)
    }

    /// Lights besides the environment.
    pub(crate) fn lights(&self) -> Vec<Light> {
        match (self.no_lights, &self.light[..]) {
            (true, _) => Vec::new(),
            (false, []) => STUDIO_LIGHTS.to_vec(),
            (false, given) => given.to_vec(),
        }
    }

    /// Background as the engine takes it.
    pub(crate) fn background(&self) -> Background {
        match self.background {
            _ if self.transparent => Background::Clear,
            BackgroundChoice::Studio => Background::Studio,
            BackgroundChoice::Environment => Background::Environment,
            BackgroundChoice::Blurred => Background::Blurred,
            // A neutral gray.
            BackgroundChoice::Plain => Background::Plain([0.05; 3]),
        }
    }
}

/// Transform from light to display colors.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TransformChoice {
    Neutral,
    Agx,
    PunchyAgx,
    Aces,
    Standard,
}

impl From<TransformChoice> for ViewTransform {
    fn from(transform: TransformChoice) -> ViewTransform {
        match transform {
            TransformChoice::Neutral => ViewTransform::Neutral,
            TransformChoice::Agx => ViewTransform::AgX,
            TransformChoice::PunchyAgx => ViewTransform::PunchyAgX,
            TransformChoice::Aces => ViewTransform::Aces,
            TransformChoice::Standard => ViewTransform::Standard,
        }
    }
}

/// Object that turns on a turntable.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TurnChoice {
    Camera,
    Light,
}

impl From<TurnChoice> for Turns {
    fn from(turn: TurnChoice) -> Turns {
        match turn {
            TurnChoice::Camera => Turns::Camera,
            TurnChoice::Light => Turns::Light,
        }
    }
}

/// Background of a picture.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum BackgroundChoice {
    Studio,
    Environment,
    Blurred,
    Plain,
}

/// Lines over the model.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum LinesChoice {
    Wires,
    Seams,
}

impl From<LinesChoice> for Lines {
    fn from(lines: LinesChoice) -> Lines {
        match lines {
            LinesChoice::Wires => Lines::Wires,
            LinesChoice::Seams => Lines::Seams,
        }
    }
}

fn picture_size(text: &str) -> Result<[u32; 2], String> {
    let sides: Option<Vec<u32>> = text.split('x').map(|side| side.parse().ok()).collect();
    match sides.as_deref() {
        Some(&[width, height]) if (1..=8192).contains(&width) && (1..=8192).contains(&height) => Ok([width, height]),
        _ => Err("it takes two sides of 1 to 8192 pixels, as in 1280x720".to_owned()),
    }
}

fn finite(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("it takes a number".to_owned()),
    }
}

/// Reads an exposure. From 128 stops on its factor would be infinite, and no light that Sabi keeps needs more than 32.
fn stops(text: &str) -> Result<f32, String> {
    let number = finite(text).ok().filter(|number| number.abs() <= 32.0);
    number.ok_or_else(|| "it takes stops from -32 to 32".to_owned())
}

fn strength(text: &str) -> Result<f32, String> {
    let number = finite(text).ok().filter(|number| *number >= 0.0);
    number.ok_or_else(|| "it takes a number from 0".to_owned())
}

fn share(text: &str) -> Result<f32, String> {
    let number = finite(text).ok().filter(|number| (0.0..=1.0).contains(number));
    number.ok_or_else(|| "it takes a share from 0 to 1".to_owned())
}

fn place(text: &str) -> Result<[f32; 3], String> {
    let numbers: Result<Vec<f32>, String> = text.split(',').map(finite).collect();
    let wrong = || "it takes three numbers, as in 0,0.2,0".to_owned();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(wrong)
}

fn light(text: &str) -> Result<Light, String> {
    let numbers: Result<Vec<f32>, String> = text.split(',').map(finite).collect();
    let (yaw, pitch, strength) = match numbers.as_deref() {
        Ok(&[yaw, pitch]) => (yaw, pitch, 2.0),
        Ok(&[yaw, pitch, strength]) if strength >= 0.0 => (yaw, pitch, strength),
        _ => return Err("it takes two angles in degrees and a strength from 0, as in 40,30,2.5".to_owned()),
    };
    Ok(Light {
        place: LightPlace::from_angles(yaw, pitch),
        color: [strength; 3],
        has_shadow: true,
        size_degrees: 2.0,
        follows_camera: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_has_two_sides() {
        assert_eq!(picture_size("640x480"), Ok([640, 480]));
        for wrong in ["640", "640x", "0x480", "640x480x3", "9000x10", "-1x5", "axb"] {
            assert!(picture_size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_bloom_is_a_share() {
        assert_eq!((share("0"), share("1"), share("0.25")), (Ok(0.0), Ok(1.0), Ok(0.25)));
        for wrong in ["-0.1", "1.1", "nan", "much"] {
            assert_eq!(share(wrong), Err("it takes a share from 0 to 1".to_owned()), "{wrong}");
        }
    }

    #[test]
    fn a_light_has_the_direction_of_its_angles() {
        let place = |text: &str| match light(text).unwrap().place {
            LightPlace::Directional(towards) | LightPlace::Point(towards) => {
                towards.map(|part| (part * 1e4).round() / 1e4)
            }
        };
        assert_eq!(place("0,0"), [0.0, 0.0, 1.0]);
        assert_eq!(place("90,0"), [1.0, 0.0, 0.0]);
        assert_eq!(place("12,90,3"), [0.0, 1.0, 0.0]);
        for wrong in ["", "1", "1,2,-3", "1,2,3,4", "a,b", "nan,0"] {
            assert!(light(wrong).is_err(), "{wrong}");
        }
    }
}
