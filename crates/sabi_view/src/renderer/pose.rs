//! A model that is seen once and shown in many looks.

use sabi_gpu::{DeviceMaps, Gpu};

use super::passes::{draw_light, draw_raster};
use super::{Renderer, Sample};
use crate::environment::Environment;
use crate::error::ViewError;
use crate::frame::Frame;
use crate::model::ViewModel;
use crate::scene::{MaterialLook, Mode, Scene, Shot};
use crate::shadows::ShadowMaps;
use crate::target::{Sight, Target};

/// A model as one camera sees it. Which place of the model each pixel sees is found once, for all looks that are shown of it:
/// on software drivers that takes far longer than the light of a small picture.
pub struct Pose {
    shot: Shot,
    target: Target,
    /// Raster's record of the pixels of each sample, with its bind group.
    sights: Vec<(Sight, wgpu::BindGroup)>,
    shadows: ShadowMaps,
    /// Look of each material: always 0, the only look.
    look_of_material: Vec<usize>,
}

/// Stands for all looks of a pose while its model is rastered.
const PLAIN: MaterialLook = MaterialLook {
    maps: DeviceMaps {
        color: None,
        surface: None,
        emission: None,
        height: None,
        normal: None,
    },
    color: [1.0; 4],
    surface: [1.0, 0.0, 1.0],
    is_opaque: true,
    node: None,
};

impl Renderer {
    /// A model as a shot sees it, without lights besides the environment, without relief and without lines.
    pub fn pose(
        &self,
        gpu: &Gpu,
        size: [u32; 2],
        model: &ViewModel,
        environment: &Environment,
        shot: &Shot,
    ) -> Result<Pose, ViewError> {
        let shot = Shot {
            has_relief: false,
            lines: Vec::new(),
            samples: shot.samples.max(1),
            ..shot.clone()
        };
        let materials = model.parts.iter().map(|part| part.material as usize + 1).max();
        // A model without parts has no materials.
        let look_of_material = vec![0; materials.unwrap_or(0)];
        let scene = Scene {
            model,
            looks: &[PLAIN],
            look_of_material: &look_of_material,
            environment,
            lights: &[],
        };
        let shadows = self.cast_shadows(gpu, &scene)?;
        let bound = self.bound(gpu, size, &scene, &shot)?;
        let target = Target::new(gpu, size)?;
        let mut sights = Vec::new();
        for sample in 0..shot.samples {
            let sight = Sight::new(gpu, size)?;
            let frame = self.frame_group(gpu, &shadows, &scene, &Frame::new(&scene, &shot, size, sample))?;
            let mut encoder = gpu
                .device()
                .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            draw_raster(&mut encoder, &sight, &scene, &frame, &bound);
            gpu.queue().submit([encoder.finish()]);
            let seen = self.seen_group(gpu, &sight, &scene);
            sights.push((sight, seen));
        }
        Ok(Pose {
            shot,
            target,
            sights,
            shadows,
            look_of_material,
        })
    }

    /// Shows a pose in a look on all of the model: a node's own result where the look has one, else the lit material. Model
    /// and environment are those of the pose.
    pub fn draw_look<'p>(
        &self,
        gpu: &Gpu,
        pose: &'p mut Pose,
        model: &ViewModel,
        environment: &Environment,
        look: &MaterialLook,
    ) -> Result<&'p Target, ViewError> {
        let shot = Shot {
            mode: if look.node.is_some() {
                Mode::Node
            } else {
                Mode::Material
            },
            ..pose.shot.clone()
        };
        let scene = Scene {
            model,
            looks: std::slice::from_ref(look),
            look_of_material: &pose.look_of_material,
            environment,
            lights: &[],
        };
        if !look.is_opaque {
            // What is behind a clear place depends on the look.
            self.draw(gpu, &mut pose.target, &scene, &shot)?;
            return Ok(&pose.target);
        }
        let bound = self.bound(gpu, pose.target.size, &scene, &shot)?;
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for ((sight, seen), number) in pose.sights.iter().zip(0..) {
            let numbers = Frame::new(&scene, &shot, pose.target.size, number);
            let frame = self.frame_group(gpu, &pose.shadows, &scene, &numbers)?;
            draw_light(&mut encoder, &pose.target.light, (sight, seen), &scene, &frame, &bound);
            let sample = Sample {
                number,
                is_shown: number + 1 == shot.samples,
            };
            self.finish_sample(gpu, &mut encoder, &mut pose.target, &shot, sample)?;
        }
        gpu.queue().submit([encoder.finish()]);
        Ok(&pose.target)
    }
}
