//! Renderer of thumbnails: one camera, one environment, a transparent background.

use std::path::Path;
use std::sync::Arc;

use sabi_gpu::Gpu;
use sabi_view::{
    Background, Camera, Environment, MaterialLook, ModelPose, Pixels, RenderTarget, Renderer,
    STUDIO_ENVIRONMENT_STRENGTH, STUDIO_LIGHTS, Scene, Shot, Viewpoint,
};

use super::event::LiveModel;
use crate::error::EngineError;
use crate::evaluating::looks::ModelLooks;
use crate::opening::environment::{DEFAULT_ENVIRONMENT, load_environment};

/// Version of the pictures. It changes whenever the same material on the same model is drawn differently, so that pictures
/// that are stored on disk are drawn again.
pub const THUMBNAIL_VERSION: u32 = 3;
/// Samples per pixel. With only one, the outline on a transparent background has visible steps.
const SAMPLES: u32 = 4;

/// Renderer of thumbnails.
pub(super) struct ThumbnailRenderer {
    renderer: Renderer,
    environment: Environment,
    /// Pose of the last model, and whether it includes the shade of the model.
    last_pose: Option<(Arc<LiveModel>, bool, ModelPose)>,
}

impl ThumbnailRenderer {
    /// Loads the environment.
    pub(super) fn new(gpu: &Gpu, cache_dir: Option<&Path>) -> Result<ThumbnailRenderer, EngineError> {
        let light = DEFAULT_ENVIRONMENT;
        // Light that could not be cached is computed again at the next start.
        let (environment, _) = load_environment(gpu, light, cache_dir)?;
        Ok(ThumbnailRenderer {
            renderer: Renderer::new(gpu)?,
            environment,
            last_pose: None,
        })
    }

    /// Returns the renderer in its place. It is created if there is none.
    pub(super) fn in_place<'r>(
        place: &'r mut Option<ThumbnailRenderer>,
        gpu: &Gpu,
        cache_dir: Option<&Path>,
    ) -> Result<&'r mut ThumbnailRenderer, EngineError> {
        match place {
            Some(renderer) => Ok(renderer),
            None => Ok(place.insert(ThumbnailRenderer::new(gpu, cache_dir)?)),
        }
    }

    /// Draws a square picture of a model with the looks of its materials.
    pub(super) fn picture_of_looks(
        &mut self,
        gpu: &Gpu,
        side: u32,
        model: &Arc<LiveModel>,
        looks: &ModelLooks,
    ) -> Result<Pixels, EngineError> {
        let is_one = looks.look_of_material.iter().all(|look| *look == 0);
        with_settled_shade(model, || match looks.looks.as_slice() {
            [look] if is_one => self.picture_of_one(gpu, side, model, look),
            _ => self.picture_of_several(gpu, side, model, looks),
        })
    }

    fn picture_of_several(
        &mut self,
        gpu: &Gpu,
        side: u32,
        model: &LiveModel,
        looks: &ModelLooks,
    ) -> Result<Pixels, EngineError> {
        let scene = Scene {
            model: &model.view,
            looks: &looks.looks,
            look_of_material: &looks.look_of_material,
            environment: &self.environment,
            lights: &STUDIO_LIGHTS,
        };
        let mut target = RenderTarget::new(gpu, [side; 2])?;
        self.renderer.draw(gpu, &mut target, &scene, &shot_of(model))?;
        Ok(target.read(gpu)?)
    }

    /// Draws a square picture of a look on the whole model.
    pub(super) fn picture(
        &mut self,
        gpu: &Gpu,
        side: u32,
        model: &Arc<LiveModel>,
        look: &MaterialLook,
    ) -> Result<Pixels, EngineError> {
        with_settled_shade(model, || self.picture_of_one(gpu, side, model, look))
    }

    fn picture_of_one(
        &mut self,
        gpu: &Gpu,
        side: u32,
        model: &Arc<LiveModel>,
        look: &MaterialLook,
    ) -> Result<Pixels, EngineError> {
        // A pose keeps the shade that the model had when the pose was created.
        let has_shade = model.view.has_shade();
        let is_same = |(known, had_shade, _): &(Arc<LiveModel>, bool, ModelPose)| {
            Arc::ptr_eq(known, model) && *had_shade == has_shade
        };
        let mut pose = match self.last_pose.take().filter(is_same) {
            Some((_, _, pose)) => pose,
            None => self.pose(gpu, side, model)?,
        };
        let ThumbnailRenderer {
            renderer, environment, ..
        } = self;
        let drawn = renderer.draw_look(gpu, &mut pose, &model.view, environment, look)?;
        let pixels = drawn.read(gpu)?;
        self.last_pose = Some((model.clone(), has_shade, pose));
        Ok(pixels)
    }

    fn pose(&self, gpu: &Gpu, side: u32, model: &LiveModel) -> Result<ModelPose, EngineError> {
        let ThumbnailRenderer {
            renderer, environment, ..
        } = self;
        Ok(renderer.pose(gpu, [side; 2], &model.view, environment, &shot_of(model))?)
    }
}

/// Draws a picture of a model. Draws it again if its shade, which another thread computes, has arrived in the meantime.
fn with_settled_shade(
    model: &LiveModel,
    mut draw: impl FnMut() -> Result<Pixels, EngineError>,
) -> Result<Pixels, EngineError> {
    loop {
        let had_shade = model.view.has_shade();
        let drawn = draw()?;
        // It arrives once.
        if model.view.has_shade() == had_shade {
            return Ok(drawn);
        }
    }
}

/// The usual view of a model.
fn shot_of(model: &LiveModel) -> Shot {
    let points = model.placement.points_in_view(&model.linked.model.mesh);
    Shot {
        background: Background::Clear,
        environment_strength: STUDIO_ENVIRONMENT_STRENGTH,
        samples: SAMPLES,
        ..Shot::new(Camera::seen_from(Viewpoint::THREE_QUARTER, &points, 1.0))
    }
}
