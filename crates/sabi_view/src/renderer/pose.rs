//! Pictures of one view of a model with many looks. Visibility is computed only once.

use sabi_gpu::{DeviceMaps, Gpu};

use super::passes::{draw_light, draw_raster};
use super::{PictureSample, Renderer};
use crate::environment::Environment;
use crate::error::ViewError;
use crate::frame::FrameUniforms;
use crate::lights::STUDIO_LIGHTS;
use crate::model::ViewModel;
use crate::render_target::{RenderTarget, VisibilityBuffer};
use crate::scene::{Light, MaterialLook, Mode, Scene, Shot};
use crate::shadows::ShadowMaps;

/// Lights of poses: those of a studio without soft shadows, so that all samples share their shadow maps.
const POSE_LIGHTS: [Light; 2] = {
    let [key, rim] = STUDIO_LIGHTS;
    [
        Light {
            size_degrees: 0.0,
            ..key
        },
        Light {
            size_degrees: 0.0,
            ..rim
        },
    ]
};

/// One view of a model, for pictures of it with many looks. Its visibility is computed once, since on software drivers that
/// takes far longer than shading a small picture.
pub struct ModelPose {
    shot: Shot,
    target: RenderTarget,
    /// Visibility buffer of each sample, with its bind group.
    visibility_buffers: Vec<(VisibilityBuffer, wgpu::BindGroup)>,
    shadows: ShadowMaps,
    /// Look of each material: always 0, the only look.
    look_of_material: Vec<usize>,
}

/// Look with which a pose is rasterized, whichever looks it is drawn with later.
const RASTER_LOOK: MaterialLook = MaterialLook {
    maps: DeviceMaps {
        color: None,
        surface: None,
        emission: None,
        height: None,
        normal: None,
        coat: None,
        anisotropy: None,
        sheen: None,
        subsurface: None,
    },
    color: [1.0; 4],
    surface: [1.0, 0.0, 1.0],
    is_opaque: true,
    node: None,
};

impl Renderer {
    /// Prepares a model as seen by a shot, in the lights of a studio, without relief and without lines.
    pub fn pose(
        &self,
        gpu: &Gpu,
        size: [u32; 2],
        model: &ViewModel,
        environment: &Environment,
        shot: &Shot,
    ) -> Result<ModelPose, ViewError> {
        let shot = Shot {
            has_relief: false,
            lines: Vec::new(),
            samples: shot.samples.max(1),
            ..shot.clone()
        };
        let materials = model.ranges.iter().map(|range| range.material as usize + 1).max();
        // A model without triangles has no materials.
        let look_of_material = vec![0; materials.unwrap_or(0)];
        let scene = Scene {
            model,
            looks: &[RASTER_LOOK],
            look_of_material: &look_of_material,
            environment,
            lights: &POSE_LIGHTS,
        };
        let bound = self.bound(gpu, size, &scene, &shot)?;
        let shadows = self.shadow_maps(gpu, &scene, &shot, &bound, None)?;
        let target = RenderTarget::new(gpu, size)?;
        let mut visibility_buffers = Vec::new();
        for sample in 0..shot.samples {
            let visibility = VisibilityBuffer::new(gpu, size)?;
            let frame = self.frame_group(gpu, &shadows, &scene, &FrameUniforms::new(&scene, &shot, size, sample))?;
            let mut encoder = gpu
                .device()
                .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            draw_raster(&mut encoder, &visibility, &scene, &frame, &bound);
            gpu.queue().submit([encoder.finish()]);
            let group = self.visibility_group(gpu, &visibility, &scene);
            visibility_buffers.push((visibility, group));
        }
        Ok(ModelPose {
            shot,
            target,
            visibility_buffers,
            shadows,
            look_of_material,
        })
    }

    /// Draws a pose with one look on the whole model. If the look has a node's own result, that is shown, otherwise the lit
    /// material. Model and environment must be those of the pose.
    pub fn draw_look<'p>(
        &self,
        gpu: &Gpu,
        pose: &'p mut ModelPose,
        model: &ViewModel,
        environment: &Environment,
        look: &MaterialLook,
    ) -> Result<&'p RenderTarget, ViewError> {
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
            lights: &POSE_LIGHTS,
        };
        if !look.is_opaque {
            // The look determines which surface is visible behind transparent places.
            self.draw(gpu, &mut pose.target, &scene, &shot)?;
            return Ok(&pose.target);
        }
        let bound = self.bound(gpu, pose.target.size, &scene, &shot)?;
        let mut encoder = gpu
            .device()
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for ((visibility, group), number) in pose.visibility_buffers.iter().zip(0..) {
            let values = FrameUniforms::new(&scene, &shot, pose.target.size, number);
            let frame = self.frame_group(gpu, &pose.shadows, &scene, &values)?;
            draw_light(
                &mut encoder,
                &pose.target.light,
                visibility,
                group,
                &scene,
                &frame,
                &bound,
                None,
            );
            let sample = PictureSample {
                number,
                is_shown: number + 1 == shot.samples,
            };
            self.finish_sample(gpu, &mut encoder, &mut pose.target, &shot, sample)?;
        }
        gpu.queue().submit([encoder.finish()]);
        Ok(&pose.target)
    }
}
