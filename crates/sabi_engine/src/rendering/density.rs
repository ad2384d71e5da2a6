//! Size of the maps that a picture needs: about one texel for each of its pixels.

use glam::{DVec2, UVec2, Vec2};
use sabi_surface::model::Mesh;
use sabi_view::{Camera, Placement, aspect_of};

use crate::remedy::Remedy;
use crate::warning::Warning;

/// Range of sizes that are chosen, in texels along a side; they are powers of two.
const CHOSEN: [u32; 2] = [256, 4096];
/// Largest maps, texels along a side.
const LARGEST: u32 = 8192;
/// Minimum share of the visible pixels that have a texel of their own.
const SERVED: f64 = 0.8;
/// Texels per pixel along a side that count as one: maps of twice the size would not be worth the few additional texels.
const ABOUT_ONE: f64 = 0.9;
/// Texels per pixel along a side below which a picture is visibly soft.
const SOFT: f64 = 0.5;

/// Returns the texels along a side of the maps with which [`SERVED`] of the pixels that show the model have one texel each; `None` if no
/// pixel shows it. `cameras` are those of all frames; the nearest one counts. Parts that are hidden behind other parts count as visible.
pub(super) fn texels_for_pixels(mesh: &Mesh, cameras: &[Camera], size: [u32; 2]) -> Option<f64> {
    let needed = cameras.iter().filter_map(|camera| texels_for(mesh, camera, size));
    needed.max_by(f64::total_cmp)
}

fn texels_for(mesh: &Mesh, camera: &Camera, size: [u32; 2]) -> Option<f64> {
    let placement = Placement::of(mesh);
    let size = UVec2::from(size).as_vec2();
    let aspect = aspect_of(size);
    let pixel_of = |vertex: u32| {
        let position = *mesh.positions.get(vertex as usize)?;
        camera.project(placement.view_from_model(position), aspect)
    };
    // For each triangle that is seen from the front: its pixels, and the texels along a side with which each pixel has one.
    let mut seen: Vec<(f64, f64)> = Vec::new();
    for corners in &mesh.triangles {
        let [Some(a), Some(b), Some(c)] = corners.map(pixel_of) else {
            continue;
        };
        let is_outside = |axis: usize| {
            let values = [a[axis], b[axis], c[axis]];
            values.iter().all(|value| *value < 0.0) || values.iter().all(|value| *value > 1.0)
        };
        // Counter-clockwise corners are clockwise in a picture whose rows go down.
        let pixels = -area([a * size, b * size, c * size]);
        let uvs = corners.map(|vertex| mesh.uvs.get(vertex as usize).copied().map(Vec2::from));
        let [Some(a), Some(b), Some(c)] = uvs else {
            continue;
        };
        let texels = (pixels / area([a, b, c]).abs()).sqrt();
        if pixels > 0.0 && texels.is_finite() && !is_outside(0) && !is_outside(1) {
            seen.push((texels, pixels));
        }
    }
    seen.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = seen.iter().map(|(_, pixels)| pixels).sum();
    let mut served = 0.0;
    let found = seen.iter().find(|(_, pixels)| {
        served += pixels;
        served >= all * SERVED
    });
    found.map(|(texels, _)| *texels)
}

fn area([a, b, c]: [Vec2; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(|at| DVec2::new(f64::from(at.x), f64::from(at.y)));
    (b - a).perp_dot(c - a) * 0.5
}

/// Returns the size of the maps for a picture that needs this many texels along a side: the power of two with about one
/// texel per pixel, within limits; the smallest size for a picture that does not show the model.
pub(super) fn chosen_size(needed: Option<f64>) -> u32 {
    let [least, most] = CHOSEN;
    let mut size = least;
    while size < most && needed.is_some_and(|needed| f64::from(size) < needed * ABOUT_ONE) {
        size *= 2;
    }
    size
}

/// Result for a picture that shows fewer than half a texel per pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softness {
    /// Width of a texel, pixels.
    pub texel_pixels: f64,
    /// Texels along a side of maps that would be sharp; `None` if no maps are large enough.
    pub enough: Option<u32>,
}

impl Softness {
    /// Returns how soft a view of a model is with maps of a size; `None` if it is not soft.
    pub fn of_view(mesh: &Mesh, camera: &Camera, pixels: [u32; 2], size: u32) -> Option<Softness> {
        Softness::of(size, texels_for_pixels(mesh, std::slice::from_ref(camera), pixels))
    }

    fn of(size: u32, needed: Option<f64>) -> Option<Softness> {
        let needed = needed.filter(|needed| f64::from(size) < needed * SOFT)?;
        let mut enough = size;
        while enough < LARGEST && f64::from(enough) < needed * ABOUT_ONE {
            enough = (enough + 1).next_power_of_two();
        }
        Some(Softness {
            texel_pixels: needed / f64::from(size),
            enough: Some(enough).filter(|enough| f64::from(*enough) >= needed * SOFT),
        })
    }
}

/// Returns a warning if a picture shows fewer than half a texel per pixel.
pub(super) fn softness(size: u32, needed: Option<f64>) -> Option<Warning> {
    let Softness { texel_pixels, enough } = Softness::of(size, needed)?;
    let soft = format!("the picture is soft: a texel of its maps of {size} × {size} is {texel_pixels:.1} pixels wide");
    let Some(enough) = enough else {
        return Some(Warning::from(format!(
            "{soft}, and no maps are large enough for a view from so near"
        )));
    };
    let sentence = format!("{soft}, and maps of {enough} × {enough} would be sharp");
    Some(Warning::new(sentence, [Remedy::LargerSize]))
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use sabi_view::{Lens, Viewpoint};

    use super::*;

    /// Returns a square of the whole sheet that faces the front, and one that faces away.
    fn squares() -> Mesh {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let uvs = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
        Mesh {
            positions: [square, square].concat(),
            // The square at the back uses a hundredth of the sheet.
            uvs: [uvs, uvs.map(|uv| uv.map(|value| value * 0.1))].concat(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]],
            ..Mesh::default()
        }
    }

    fn camera(mesh: &Mesh, yaw: f32) -> Camera {
        let points: Vec<Vec3> = Placement::of(mesh).points_in_view(mesh);
        Camera {
            lens: Lens::Orthographic,
            ..Camera::seen_from(Viewpoint::at(yaw, 0.0), &points, 1.0)
        }
    }

    #[test]
    fn a_square_needs_as_many_texels_as_its_side_has_pixels() {
        let mesh = squares();
        let front = camera(&mesh, 0.0);
        let at = |x: f32| front.project(Vec3::new(x, 0.0, 0.0), 1.0).unwrap().x;
        let side = f64::from(at(0.5) - at(-0.5));
        for size in [100, 400, 1600] {
            let needed = texels_for_pixels(&mesh, &[front], [size; 2]).unwrap();
            assert!(
                (needed - side * f64::from(size)).abs() < 0.01 * needed,
                "{needed} for {size}"
            );
        }
        let behind = texels_for_pixels(&mesh, &[camera(&mesh, 180.0)], [400; 2]).unwrap();
        let both = texels_for_pixels(&mesh, &[front, camera(&mesh, 180.0)], [400; 2]).unwrap();
        assert!(
            (behind - 10.0 * side * 400.0).abs() < 0.01 * behind && both == behind,
            "{behind}"
        );
    }

    #[test]
    fn a_model_that_is_not_visible_needs_no_texels() {
        let mesh = squares();
        let away = Camera {
            target: Vec3::new(9.0, 0.0, 0.0),
            ..camera(&mesh, 0.0)
        };
        assert_eq!(texels_for_pixels(&mesh, &[away], [400; 2]), None);
        assert_eq!(texels_for_pixels(&Mesh::default(), &[away], [400; 2]), None);
        assert_eq!(chosen_size(None), 256);
    }

    #[test]
    fn the_size_is_the_power_of_two_with_about_a_texel_for_a_pixel() {
        for (needed, size) in [
            (1.0, 256),
            (256.0, 256),
            (284.0, 256),
            (286.0, 512),
            (1000.0, 1024),
            (1900.0, 2048),
            (9000.0, 4096),
            (f64::INFINITY, 4096),
        ] {
            assert_eq!(chosen_size(Some(needed)), size, "{needed}");
        }
    }

    #[test]
    fn fewer_than_half_a_texel_per_pixel_gives_a_warning() {
        assert_eq!(softness(512, None), None);
        assert_eq!(softness(512, Some(1024.0)), None);
        let said = |size: u32, needed: f64| softness(size, Some(needed)).map(|warning| warning.to_string());
        assert_eq!(
            said(512, 1300.0).as_deref(),
            Some(
                "the picture is soft: a texel of its maps of 512 × 512 is 2.5 pixels wide, and maps of 2048 × 2048 would be \
                 sharp; choose a larger size"
            )
        );
        assert_eq!(
            said(4096, 50_000.0).as_deref(),
            Some(
                "the picture is soft: a texel of its maps of 4096 × 4096 is 12.2 pixels wide, and no maps are large enough for \
                 a view from so near"
            )
        );
    }
}
