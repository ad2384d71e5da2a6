//! Light of a picture before its view transform.

use sabi_gpu::Gpu;

use super::{PictureSample, Renderer};
use crate::error::ViewError;
use crate::render_target::RenderTarget;
use crate::scene::{Scene, Shot};

impl Renderer {
    /// Returns the light of a shot of the lit material, the mean of all samples: linear, scene-referred and exposed,
    /// without a view transform. RGB is premultiplied by the fourth component, the coverage of the pixel. A plain
    /// background has a coverage of 0. Row by row from the top.
    pub fn light(
        &self,
        gpu: &Gpu,
        target: &mut RenderTarget,
        scene: &Scene<'_>,
        shot: &Shot,
    ) -> Result<Vec<[f32; 4]>, ViewError> {
        let mut prepared = self.prepare(gpu, target, scene, shot, None)?;
        let [width, height] = target.size.map(|side| side as usize);
        let mut sums = vec![[0.0; 4]; width * height];
        let samples = shot.samples.max(1);
        for sample in 0..samples {
            let next = PictureSample {
                number: sample,
                is_shown: false,
            };
            self.add_sample(gpu, target, scene, shot, &mut prepared, next)?;
            for (sum, light) in sums.iter_mut().zip(target.read_light(gpu)?) {
                *sum = [0, 1, 2, 3].map(|at| sum[at] + f64::from(light[at]));
            }
        }
        let share = f64::from(samples).recip();
        let exposed = f64::from(shot.exposure_stops).exp2() * share;
        let mean = |[r, g, b, cover]: [f64; 4]| [r * exposed, g * exposed, b * exposed, cover * share];
        Ok(sums
            .into_iter()
            .map(|sum| mean(sum).map(|value| value as f32))
            .collect())
    }
}
