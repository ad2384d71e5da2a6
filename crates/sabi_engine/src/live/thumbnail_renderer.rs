//! Renderer of thumbnails: one camera, one environment, a transparent background.

use std::path::Path;
use std::sync::Arc;

use sabi_gpu::Gpu;
use sabi_view::{
    Background, Camera, Environment, MaterialLook, Pixels, Pose, Renderer, STUDIO_ENVIRONMENT_STRENGTH, Shot, Viewpoint,
};

use super::event::LiveModel;
use crate::error::EngineError;
use crate::opening::environment::{DEFAULT_ENVIRONMENT, load_environment};

/// Samples per pixel; without several the outline on a transparent background has visible steps.
const SAMPLES: u32 = 4;

/// Renderer of thumbnails.
pub(super) struct ThumbnailRenderer {
    renderer: Renderer,
    environment: Environment,
    /// Pose of the last model.
    last_pose: Option<(Arc<LiveModel>, Pose)>,
}

impl ThumbnailRenderer {
    /// Loads the environment.
    pub(super) fn new(gpu: &Gpu, cache_dir: Option<&Path>) -> Result<ThumbnailRenderer, EngineError> {
        let light = DEFAULT_ENVIRONMENT;
        // A light that could not be cached is computed again at the next start.
        let (environment, _) = load_environment(gpu, light, cache_dir)?;
        Ok(ThumbnailRenderer {
            renderer: Renderer::new(gpu)?,
            environment,
            last_pose: None,
        })
    }

    /// Draws a square picture of a look on the whole model.
    pub(super) fn picture(
        &mut self,
        gpu: &Gpu,
        side: u32,
        model: &Arc<LiveModel>,
        look: &MaterialLook,
    ) -> Result<Pixels, EngineError> {
        let is_same = |(last_pose, _): &(Arc<LiveModel>, Pose)| Arc::ptr_eq(last_pose, model);
        let mut pose = match self.last_pose.take().filter(is_same) {
            Some((_, pose)) => pose,
            None => self.pose(gpu, side, model)?,
        };
        let ThumbnailRenderer {
            renderer, environment, ..
        } = self;
        let drawn = renderer.draw_look(gpu, &mut pose, &model.view, environment, look)?;
        let pixels = drawn.read(gpu)?;
        self.last_pose = Some((model.clone(), pose));
        Ok(pixels)
    }

    fn pose(&self, gpu: &Gpu, side: u32, model: &LiveModel) -> Result<Pose, EngineError> {
        let points = model.placement.points_in_view(&model.linked.model.mesh);
        let shot = Shot {
            background: Background::Clear,
            environment_strength: STUDIO_ENVIRONMENT_STRENGTH,
            samples: SAMPLES,
            ..Shot::new(Camera::seen_from(Viewpoint::THREE_QUARTER, &points, 1.0))
        };
        let ThumbnailRenderer {
            renderer, environment, ..
        } = self;
        Ok(renderer.pose(gpu, [side; 2], &model.view, environment, &shot)?)
    }
}
