//! Intersection of a ray with a chart's relief by fine marching on the processor: the reference for the shader.
//!
//! Relief space is (texel u, texel v, height): texels on the page of the chart, heights in model units along the normal, as
//! stored. The surface itself is at height 0; heights may be in front of it (above 0) and behind it (below 0). A ray enters
//! at the highest height and goes down to the lowest. It hits the relief at the first point that is not above the relief.

/// Steps of the march in one texel.
const STEPS_PER_TEXEL: f64 = 64.0;
/// Minimum and maximum number of steps of a march.
const STEPS: [f64; 2] = [256.0, 4e6];
/// Bisections of the step in which the ray goes below the relief.
const BISECTIONS: u32 = 40;

/// Linear transform of directions into relief space at one point of a surface. The texels are assumed to be equal parallelograms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefFrame {
    /// Step of one texel to the right, model units.
    pub model_from_texel_u: [f64; 3],
    /// Step of one texel down, model units.
    pub model_from_texel_v: [f64; 3],
    /// Normal, unit length.
    pub normal: [f64; 3],
}

impl ReliefFrame {
    /// Transforms a direction from model space to relief space: (texels, texels, model units). Returns `None` for a degenerate frame.
    pub fn relief_from_model(&self, direction: [f64; 3]) -> Option<[f64; 3]> {
        let [u, v, n] = [self.model_from_texel_u, self.model_from_texel_v, self.normal].map(glam::DVec3::from);
        let solved = glam::DMat3::from_cols(u, v, n).inverse() * glam::DVec3::from(direction);
        solved.is_finite().then(|| solved.to_array())
    }
}

/// Hit of a ray with a relief.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefHit {
    /// Position on the page in texels.
    pub texel: [f64; 2],
    /// Height at that position in model units.
    pub height: f64,
}

/// Returns the first hit of a ray with a relief. `texel` is its intersection with the surface itself (height 0), `direction` its direction
/// in relief space; all heights are between `low` and `high`. Returns `None` for rays that do not go down.
///
/// A ray that starts below the relief (at `high`, so only because of rounding) hits it at its start.
pub fn march(
    height: impl Fn([f64; 2]) -> f64,
    texel: [f64; 2],
    direction: [f64; 3],
    [low, high]: [f64; 2],
) -> Option<ReliefHit> {
    let [u, v, down] = direction;
    if !(down < 0.0 && u.is_finite() && v.is_finite() && low <= high) {
        return None;
    }
    // The parameter along the ray is its height, 0 at the surface.
    let slope = [u / down, v / down];
    let at = |ray: f64| [0, 1].map(|axis| texel[axis] + slope[axis] * ray);
    let is_below = |ray: f64| ray <= height(at(ray));
    let hit = |ray: f64| {
        Some(ReliefHit {
            texel: at(ray),
            height: ray,
        })
    };
    let texels = slope[0].hypot(slope[1]) * (high - low);
    let steps = (texels * STEPS_PER_TEXEL).clamp(STEPS[0], STEPS[1]).ceil();
    let ray_at = |step: f64| high + (low - high) * (step / steps);
    let mut above = high;
    if is_below(above) {
        return hit(above);
    }
    let mut step = 1.0;
    while step < steps && !is_below(ray_at(step)) {
        above = ray_at(step);
        step += 1.0;
    }
    // At the lowest height, the ray counts as below the relief in spite of rounding.
    let mut below = ray_at(step);
    for _ in 0..BISECTIONS {
        let middle = (above + below) * 0.5;
        if is_below(middle) {
            below = middle;
        } else {
            above = middle;
        }
    }
    hit(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-6
    }

    #[test]
    fn a_flat_relief_is_hit_where_the_ray_reaches_its_height() {
        for level in [-0.3, 0.0, 0.2] {
            let hit = march(|_| level, [10.0, 20.0], [3.0, -1.0, -0.5], [-0.4, 0.4]).unwrap();
            assert!(near(hit.height, level));
            assert!(near(hit.texel[0], 10.0 - 6.0 * level) && near(hit.texel[1], 20.0 + 2.0 * level));
        }
        let straight = march(|_| -0.1, [1.0, 2.0], [0.0, 0.0, -1.0], [-0.1, -0.1]).unwrap();
        assert_eq!((straight.texel, straight.height), ([1.0, 2.0], -0.1));
    }

    #[test]
    fn a_slope_is_hit_where_two_lines_cross() {
        // Height 0.1 u and a ray through (4, 0): u = 4 − 2 h, so h = 0.4 − 0.2 h.
        let hit = march(|[u, _]| 0.1 * u, [4.0, 0.0], [1.0, 0.0, -0.5], [-1.0, 1.0]).unwrap();
        assert!(near(hit.height, 0.4 / 1.2) && near(hit.texel[0], 4.0 - 0.8 / 1.2));
    }

    #[test]
    fn the_first_of_several_ridges_is_hit() {
        let ridges = |[u, _]: [f64; 2]| if u.rem_euclid(2.0) < 0.25 { 1.0 } else { 0.0 };
        let hit = march(ridges, [9.0, 0.0], [4.0, 0.0, -0.5], [0.0, 1.0]).unwrap();
        assert!(
            near(hit.texel[0], 2.0),
            "it enters at 1 and the next ridge begins at 2: {hit:?}"
        );
        assert!(near(hit.height, 7.0 / 8.0));
    }

    #[test]
    fn rays_that_do_not_go_down_hit_nothing() {
        for direction in [
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [f64::NAN, 0.0, -1.0],
            [0.0, 0.0, f64::NAN],
        ] {
            assert_eq!(march(|_| 0.0, [0.0; 2], direction, [0.0, 1.0]), None);
        }
        assert_eq!(march(|_| 0.0, [0.0; 2], [0.0, 0.0, -1.0], [1.0, 0.0]), None);
    }

    #[test]
    fn a_direction_is_measured_in_texels_of_the_surface() {
        let frame = ReliefFrame {
            model_from_texel_u: [0.5, 0.0, 0.0],
            model_from_texel_v: [0.25, -0.5, 0.0],
            normal: [0.0, 0.0, 1.0],
        };
        assert_eq!(frame.relief_from_model([0.75, -0.5, -2.0]), Some([1.0, 1.0, -2.0]));
        let flat = ReliefFrame {
            model_from_texel_v: [1.0, 0.0, 0.0],
            ..frame
        };
        assert_eq!(flat.relief_from_model([0.0, 0.0, -1.0]), None);
    }
}
