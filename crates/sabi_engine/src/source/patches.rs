//! Tiling without visible repeats: a plane of overlapping hexagonal patches, each of which shows another part of a picture.
//!
//! The grid and its weights are those of Mikkelsen 2022, "Practical Real-Time Hex-Tiling" (JCGT 11(2)). Patches are blended
//! such that mean and variance of the picture stay (Heitz and Neyret 2018, "High-Performance By-Example Noise using a
//! Histogram-Preserving Blending Operator", section 3.2): the weighted sum of deviations from the mean, divided by the length
//! of the weights. Weights do not depend on the picture, so that several pictures of one material stay aligned.

use sabi_plan::pcg;

use super::sampler::Footprint;

/// Triangles of the grid along a side of a tile: two hexagons and a half fit into it.
const GRID: f64 = 3.464_101_615_137_754_6;
/// Exponent of the weights: at 1 patches fade over their whole width, higher values leave more of each as it is.
const SHARPNESS: i32 = 4;

/// Part of a picture that a patch shows at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patch {
    pub(crate) footprint: Footprint,
    /// Factor of the deviation from the picture's mean; the squares of all patches of a point sum to 1.
    pub(crate) weight: f32,
    /// Cosine and sine of the rotation of the patch, counter-clockwise.
    pub(crate) turn: [f32; 2],
}

/// Arrangement of patches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Patches {
    seed: u32,
    /// Largest rotation of a patch, radians.
    most_turned: f64,
    /// Height of the picture divided by its width.
    aspect: f64,
}

impl Patches {
    pub(crate) fn new(seed: u32, most_turned: f64, aspect: f64) -> Patches {
        Patches {
            seed,
            most_turned,
            aspect,
        }
    }

    /// Returns the patches at a footprint on the repeated picture.
    pub(crate) fn at(&self, footprint: &Footprint) -> [Patch; 3] {
        // On a plane where the picture is as wide as 1 and has square pixels.
        let plane = |[u, v]: [f64; 2]| [u, v * self.aspect];
        let at = plane(footprint.uv);
        let corners = corners([at[0] * GRID, at[1] * GRID]);
        let weights = corners.map(|(_, weight)| weight.powi(SHARPNESS));
        let length = weights.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
        std::array::from_fn(|index| {
            let (corner, _) = corners[index];
            let [across, down, turned] = self.random(corner);
            let middle = center(corner).map(|x| x / GRID);
            let (sin, cos) = ((2.0 * turned - 1.0) * self.most_turned).sin_cos();
            let turn = |[x, y]: [f64; 2]| [cos * x - sin * y, (sin * x + cos * y) / self.aspect];
            let [u, v] = turn([at[0] - middle[0], at[1] - middle[1]]);
            Patch {
                footprint: Footprint {
                    uv: [u + middle[0] + across, v + middle[1] / self.aspect + down],
                    steps: footprint.steps.map(|step| turn(plane(step))),
                },
                weight: (weights[index] / length) as f32,
                turn: [cos as f32, sin as f32],
            }
        })
    }

    /// Three random numbers from 0 to 1 for a corner of the grid.
    fn random(&self, [column, row]: [i64; 2]) -> [f64; 3] {
        let first = pcg(pcg(self.seed ^ 0x9e37_79b9) ^ column as u32);
        let second = pcg(first ^ (row as u32).rotate_left(16));
        let third = pcg(second ^ 0x85eb_ca6b);
        [second, third, pcg(third)].map(|bits| f64::from(bits) / f64::from(u32::MAX))
    }
}

/// Corners of the triangle around a point of the grid, with weights that sum to 1.
fn corners([x, y]: [f64; 2]) -> [([i64; 2], f64); 3] {
    let skewed = [x - y / 3.0_f64.sqrt(), 2.0 * y / 3.0_f64.sqrt()];
    let base = skewed.map(|x| x.floor() as i64);
    let [fx, fy] = skewed.map(|x| x - x.floor());
    let step = |across: i64, down: i64| [base[0].wrapping_add(across), base[1].wrapping_add(down)];
    let rest = 1.0 - fx - fy;
    if rest > 0.0 {
        [(step(0, 0), rest), (step(0, 1), fy), (step(1, 0), fx)]
    } else {
        [(step(1, 1), -rest), (step(1, 0), 1.0 - fy), (step(0, 1), 1.0 - fx)]
    }
}

/// Place of a corner on the plane of the grid.
fn center([column, row]: [i64; 2]) -> [f64; 2] {
    [column as f64 + 0.5 * row as f64, 0.5 * 3.0_f64.sqrt() * row as f64]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn footprint(uv: [f64; 2]) -> Footprint {
        Footprint {
            uv,
            steps: [[0.01, 0.0], [0.0, 0.01]],
        }
    }

    #[test]
    fn weights_keep_the_variance_and_change_without_a_jump() {
        let patches = Patches::new(7, 3.0, 0.5);
        let mut before: Option<Vec<(f64, f64)>> = None;
        for step in 0..4000 {
            let at = f64::from(step) * 1e-3;
            let here = patches.at(&footprint([at, 0.37 * at]));
            let squares: f32 = here.iter().map(|patch| patch.weight * patch.weight).sum();
            assert!((squares - 1.0).abs() < 1e-5, "{squares}");
            // A patch is known by its rotation.
            let now: Vec<(f64, f64)> = here
                .iter()
                .map(|p| (f64::from(p.turn[1]), f64::from(p.weight)))
                .collect();
            let of = |list: &[(f64, f64)], turn: f64| {
                list.iter()
                    .filter(|(own, _)| (own - turn).abs() < 1e-6)
                    .map(|(_, weight)| *weight)
                    .sum::<f64>()
            };
            if let Some(before) = &before {
                for (turn, _) in before.iter().chain(&now) {
                    assert!((of(before, *turn) - of(&now, *turn)).abs() < 0.05, "a jump at {at}");
                }
            }
            before = Some(now);
        }
    }

    #[test]
    fn a_patch_is_the_picture_moved_and_turned_and_never_stretched() {
        let aspect = 0.5;
        let patches = Patches::new(3, 2.0, aspect);
        let [near, beside] = [[0.3, 0.2], [0.301, 0.2]].map(|uv| patches.at(&footprint(uv)));
        for (near, beside) in near.iter().zip(&beside) {
            let [u, v] = [0, 1].map(|axis| beside.footprint.uv[axis] - near.footprint.uv[axis]);
            assert!((u.hypot(v * aspect) - 1e-3).abs() < 1e-9);
            let [cos, sin] = near.turn.map(f64::from);
            assert!((u - 1e-3 * cos).abs() < 1e-9 && (v * aspect - 1e-3 * sin).abs() < 1e-9);
        }
    }
}
