//! Projection of a picture onto a surface, with the parameters of `source/image`: by texture coordinates, triplanar, or as a decal.

use glam::Vec3;
use sabi_gpu::{ProjectionConstants, ProjectionWay};
use sabi_plan::{NoSuchValue, SourceValues};

/// Projection of a picture, and the properties for which the kernel is specialized.
pub(super) struct Projection {
    pub(super) way: ProjectionWay,
    /// True for a file with several pictures, of which one is used.
    pub(super) has_cells: bool,
    pub(super) constants: ProjectionConstants,
}

impl Projection {
    /// Reads the parameters of `source/image`; `pixels` is the size of the picture.
    pub(super) fn new(values: &SourceValues, pixels: [u32; 2]) -> Result<Projection, NoSuchValue> {
        let (sin, cos) = values.number("rotate")?.sin_cos();
        let sides = [values.number("columns")?, values.number("rows")?];
        let cells = sides.map(|side| side.round().max(1.0));
        let [width, height] = pixels.map(|side| side.max(1) as f32);
        let [right, up, toward] = directions(values)?.map(|axis| axis.to_array());
        let constants = ProjectionConstants {
            size: values.number("size")?,
            aspect: height * cells[0] / (width * cells[1]),
            turn: [cos, sin],
            offset: values.numbers::<2>("offset")?,
            tiles: values.numbers::<2>("tiles")?,
            cells,
            half_pixel: [0.5 / width, 0.5 / height],
            sharpness: values.number("sharpness")?,
            depth: values.number("depth")?,
            middle: values.numbers::<3>("position")?,
            facing: values.number("facing")?,
            right,
            up,
            toward,
            pad: 0.0,
        };
        Ok(Projection {
            way: match values.index("projection")? {
                0 => ProjectionWay::Uv,
                1 => ProjectionWay::Triplanar,
                _ => ProjectionWay::Decal,
            },
            has_cells: cells != [1.0; 2],
            constants,
        })
    }

    /// Returns whether the picture repeats.
    pub(super) fn repeats(&self) -> bool {
        self.way != ProjectionWay::Decal
    }
}

/// Returns the directions in model space to the right and to the top of a decal, and the direction that it faces, as unit vectors.
fn directions(values: &SourceValues) -> Result<[Vec3; 3], NoSuchValue> {
    let vector = |name: &str| Ok::<_, NoSuchValue>(Vec3::from(values.numbers::<3>(name)?));
    let toward = vector("toward")?.try_normalize().unwrap_or(Vec3::Z); // A vector without length has no direction.
    // Another axis replaces an `up` that is parallel to `toward`.
    let otherwise = if toward.y.abs() < 0.9 { Vec3::Y } else { Vec3::NEG_Z };
    let right = vector("up")?.cross(toward);
    let right = if right.length_squared() > 1e-12 {
        right
    } else {
        otherwise.cross(toward)
    };
    let right = right.normalize();
    Ok([right, toward.cross(right), toward])
}
