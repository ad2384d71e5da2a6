//! Stencils: pictures in front of the view, through which a stroke is painted.

use glam::{DAffine3, DMat4, DVec2, DVec3, DVec4};
use serde::{Deserialize, Serialize};

use crate::picture::PictureTip;

/// Minimum depth of a place in front of the eye, as computed by the last row of a stencil's matrix.
const LEAST_DEPTH: f64 = 1e-9;

/// A picture in front of the view, through which a stroke is painted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stencil {
    /// The picture. If its own colors are used, strokes have these colors.
    pub picture: PictureTip,
    /// Rows that map a point of the model (with a fourth component of 1) to x, y and depth. x over depth is −1 at the picture's left and 1
    /// at its right, y over depth −1 at its bottom and 1 at its top. Points whose depth is not above 0 are behind the eye.
    pub picture_from_model: [[f64; 4]; 3],
}

/// A place behind a stencil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BehindStencil {
    /// Position in the picture, −1 to 1 in x and y.
    pub(crate) place: DVec2,
    /// Gradients of x and of y in model space.
    gradients: [DVec3; 2],
}

impl BehindStencil {
    /// Returns the width of a texel on a surface with this normal, in halves of the picture's longer side. `half_sides` are
    /// those of the picture.
    pub(crate) fn width(&self, texel: f64, normal: DVec3, half_sides: DVec2) -> f64 {
        let [x, y] = self.gradients.map(|step| (step - step.dot(normal) * normal).length());
        texel * (x * half_sides.x).max(y * half_sides.y)
    }
}

impl Stencil {
    /// Returns true if all its numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.picture_from_model
            .iter()
            .flatten()
            .all(|number| number.is_finite())
    }

    /// Returns the stencil for a model that is moved together with it.
    pub(crate) fn moved(&self, moved: &DAffine3) -> Stencil {
        let back = DMat4::from(moved.inverse()).transpose();
        let mapped = self.picture_from_model.map(|row| (back * DVec4::from(row)).to_array());
        Stencil {
            picture_from_model: mapped,
            ..self.clone()
        }
    }

    /// Returns the position in the picture that covers a place of the model; `None` if the place is behind the eye.
    pub(crate) fn behind(&self, place: DVec3) -> Option<BehindStencil> {
        let rows = self.picture_from_model.map(DVec4::from);
        let [x, y, depth] = rows.map(|row| row.dot(place.extend(1.0)));
        let slope = rows[2].truncate();
        let gradient = |row: DVec4, value: f64| (depth * row.truncate() - value * slope) / (depth * depth);
        (depth > LEAST_DEPTH).then(|| BehindStencil {
            place: DVec2::new(x, y) / depth,
            gradients: [gradient(rows[0], x), gradient(rows[1], y)],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{PictureName, PicturePart};

    /// Returns a stencil for an eye at z = 4 that looks along −z. At a distance of 2 it is 2 wide and 1 high.
    fn stencil() -> Stencil {
        Stencil {
            picture: PictureTip {
                picture: PictureName::of(b"stencil", "png").unwrap(),
                part: PicturePart::Light,
            },
            picture_from_model: [[2.0, 0.0, 0.0, 0.0], [0.0, 4.0, 0.0, 0.0], [0.0, 0.0, -1.0, 4.0]],
        }
    }

    #[test]
    fn a_stencil_covers_the_places_on_lines_from_the_eye_through_it() {
        let at = |place: [f64; 3]| stencil().behind(DVec3::from(place)).map(|behind| behind.place);
        assert_eq!(at([1.0, 0.5, 2.0]), Some(DVec2::ONE));
        assert_eq!(at([2.0, -1.0, 0.0]), Some(DVec2::new(1.0, -1.0)));
        assert_eq!(at([0.0, 0.0, 4.5]), None);
    }

    #[test]
    fn a_texel_behind_a_stencil_has_the_width_that_the_eye_sees() {
        let behind = stencil().behind(DVec3::ZERO).unwrap();
        let half_sides = DVec2::new(1.0, 0.5);
        assert!((behind.width(0.1, DVec3::Z, half_sides) - 0.05).abs() < 1e-12);
        // In the middle, a step along a surface that the eye sees edge-on does not change x in the picture.
        assert!((behind.width(0.1, DVec3::X, half_sides) - 0.05).abs() < 1e-12);
        let off = stencil().behind(DVec3::new(1.0, 0.0, 0.0)).unwrap();
        let width = off.width(1e-6, DVec3::Y, half_sides);
        let step = stencil().behind(DVec3::new(1.0, 0.0, 1e-6)).unwrap().place - off.place;
        assert!(width >= step.x.abs());
    }

    #[test]
    fn a_moved_stencil_covers_what_moved_with_it() {
        let moved = DAffine3::from_rotation_y(0.7) * DAffine3::from_translation(DVec3::new(0.3, -2.0, 1.0));
        let place = DVec3::new(0.2, 0.1, 0.4);
        let [before, after] = [
            (stencil(), place),
            (stencil().moved(&moved), moved.transform_point3(place)),
        ]
        .map(|(stencil, place)| stencil.behind(place).unwrap().place);
        assert!(before.distance(after) < 1e-12, "{before} {after}");
    }
}
