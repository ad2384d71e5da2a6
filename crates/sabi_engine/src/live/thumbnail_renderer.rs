//! Where thumbnails are taken: one camera, one light, nothing behind the model.

use std::path::Path;
use std::sync::Arc;

use sabi_gpu::Gpu;
use sabi_view::{Background, Camera, Environment, MaterialLook, Pixels, Pose, Renderer, Shot, Viewpoint};

use super::event::LiveModel;
use crate::error::EngineError;
use crate::opening::environment::{built_in_environments, load_environment};

/// Pictures from slightly different places within each pixel: an outline on a clear background shows its steps.
const SAMPLES: u32 = 4;

/// Takes pictures of models.
pub(super) struct ThumbnailRenderer {
    renderer: Renderer,
    environment: Environment,
    /// The last model, as it sits for its pictures.
    last_pose: Option<(Arc<LiveModel>, Pose)>,
}

impl ThumbnailRenderer {
    /// Sets up the light.
    pub(super) fn new(gpu: &Gpu, cache_dir: Option<&Path>) -> Result<ThumbnailRenderer, EngineError> {
        let light = built_in_environments().next().unwrap_or_default();
        // What could not be kept on disk is made again the next time.
        let (environment, _) = load_environment(gpu, light, cache_dir)?;
        Ok(ThumbnailRenderer {
            renderer: Renderer::new(gpu)?,
            environment,
            last_pose: None,
        })
    }

    /// A square picture of a look on all of a model.
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
        let bounds = model.placement.box_in_view(&model.linked.model.mesh);
        let shot = Shot {
            background: Background::Clear,
            samples: SAMPLES,
            ..Shot::new(Camera::seen_from(Viewpoint::THREE_QUARTER, bounds, 1.0))
        };
        let ThumbnailRenderer {
            renderer, environment, ..
        } = self;
        Ok(renderer.pose(gpu, [side; 2], &model.view, environment, &shot)?)
    }
}
