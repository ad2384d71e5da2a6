//! Means over rays, compared with the expected value of each texel as exactly as their randomness allows.

use glam::DVec3;
use sabi_tests::OnMesh;

/// Mean difference of texels from their expected values, and four standard deviations of this mean.
#[derive(Debug)]
pub(crate) struct MeanDifference {
    pub(crate) count: u32,
    pub(crate) difference: f64,
    pub(crate) chance: f64,
}

impl MeanDifference {
    /// Of a result where something is expected. `variance` is that of a single ray where its mean is given.
    pub(crate) fn new(
        on_mesh: &OnMesh,
        values: &[f32],
        rays: u32,
        expected: impl Fn(DVec3) -> Option<f64>,
        variance: impl Fn(f64) -> f64,
    ) -> MeanDifference {
        let (mut count, mut difference, mut spread) = (0, 0.0, 0.0);
        for (index, _) in on_mesh.owned() {
            let Some(expected) = on_mesh.position(index).and_then(&expected) else {
                continue;
            };
            count += 1;
            difference += f64::from(values[index]) - expected;
            spread += variance(expected) / f64::from(rays);
        }
        let texels = f64::from(count.max(1));
        MeanDifference {
            count,
            difference: difference / texels,
            chance: 4.0 * spread.sqrt() / texels,
        }
    }

    /// Fails unless the two are equal within the random error and `slack`, the known error of the model itself.
    pub(crate) fn assert(&self, slack: f64, what: &str) {
        assert!(self.count > 100, "{what}: only {} texels", self.count);
        assert!(self.difference.abs() <= self.chance + slack, "{what}: {self:?}");
    }
}
