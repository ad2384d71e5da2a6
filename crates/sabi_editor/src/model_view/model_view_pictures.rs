//! Pictures of the model: drawn where they have changed, and registered as textures of the window.

use std::sync::Arc;

use eframe::egui_wgpu::RenderState;
use egui::{Context, Rect, TextureId, Ui};
use sabi_engine::EngineError;
use sabi_gpu::Gpu;
use sabi_view::{Environment, Light, Pixels, Scene, SceneRevision, Shot, ViewError, Viewport};

use super::environment_loader::EnvironmentLoader;
use super::lights::Lights;
use super::renderer_loader::RendererLoader;
use crate::evaluation::ResultPicture;

/// Picture on the screen, with the texture that the window knows it by.
struct ScreenPicture {
    viewport: Viewport,
    texture: Option<(TextureId, wgpu::Texture)>,
}

/// Index of the first picture of a model beside the main one, after those of the shown and of the pinned result.
pub(super) const FIRST_BESIDE: usize = 2;

/// Pictures of the shown result and of the pinned one beside it, and of other models.
#[derive(Default)]
pub(crate) struct ModelViewPictures {
    screens: Vec<Option<ScreenPicture>>,
    renderer_loader: RendererLoader,
    /// Error sentence, where there is no picture.
    pub(super) fault: Option<String>,
    /// Number of pictures of the main model that were drawn.
    pub(crate) drawn: u64,
}

/// Light in which all pictures of a frame are drawn.
pub(super) struct Lighting<'a> {
    environment: Option<&'a Environment>,
    lights: Vec<Light>,
    /// Bits that change with the environment and the lights.
    revision: u64,
}

impl<'a> Lighting<'a> {
    pub(super) fn of(environment: &'a EnvironmentLoader, lights: &Lights) -> Lighting<'a> {
        Lighting {
            environment: environment.environment(),
            lights: lights.lights(),
            revision: (environment.number() << 48) ^ (lights.number() << 32),
        }
    }

    /// Draws the next sample of a picture into a viewport. Returns whether it drew, after which more samples may be missing.
    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        viewport: &mut Viewport,
        picture: &ResultPicture,
        shot: &Shot,
        size: [u32; 2],
    ) -> Result<bool, ViewError> {
        let Some(environment) = self.environment else {
            return Ok(true);
        };
        let scene = self.scene(picture, environment);
        // The revision also changes with the environment and the lights.
        viewport.show(gpu, &scene, &self.revision_of(picture), shot, size, false)
    }

    /// Number that changes whenever the scene does, with those of earlier scenes that look the same outside of some boxes.
    fn revision_of(&self, picture: &ResultPicture) -> SceneRevision {
        let of = |number: u64| number ^ self.revision ^ (u64::from(picture.model.view.has_shade()) << 31);
        SceneRevision {
            number: of(picture.number),
            changed: picture
                .changed
                .iter()
                .map(|(number, bounds)| (of(*number), bounds.clone()))
                .collect(),
        }
    }

    fn scene(&'a self, picture: &'a ResultPicture, environment: &'a Environment) -> Scene<'a> {
        Scene {
            model: &picture.model.view,
            looks: &picture.looks.looks,
            look_of_material: &picture.looks.look_of_material,
            environment,
            lights: &self.lights,
        }
    }
}

/// Picture to draw: a result from a camera, in a light.
pub(super) struct PictureRequest<'a> {
    pub(super) picture: &'a ResultPicture,
    pub(super) shot: Shot,
    pub(super) lighting: &'a Lighting<'a>,
    /// True while the picture changes in every frame, which allows a lower quality.
    pub(super) is_moving: bool,
}

impl ModelViewPictures {
    /// Pixels of the shown picture, if there is one.
    pub(crate) fn shown(&self, gpu: &Arc<Gpu>) -> Option<Pixels> {
        self.pixels(0, gpu).ok().flatten()
    }

    /// Pixels of one picture, if there is one.
    pub(super) fn pixels(&self, at: usize, gpu: &Arc<Gpu>) -> Result<Option<Pixels>, ViewError> {
        let screen = self.screens.get(at).and_then(Option::as_ref);
        let target = screen.and_then(|screen| screen.viewport.picture());
        target.map(|target| target.read(gpu)).transpose()
    }

    /// Returns whether there is a picture of a model beside the main one.
    #[cfg(test)]
    pub(super) fn has_beside(&self, at: usize) -> bool {
        let screen = self.screens.get(FIRST_BESIDE + at).and_then(Option::as_ref);
        screen.is_some_and(|screen| screen.texture.is_some())
    }

    /// A viewport for a picture that is not shown; `None` while the renderer is being made.
    pub(super) fn new_viewport(&self, gpu: &Gpu) -> Option<Viewport> {
        let renderer = self.renderer_loader.made()?;
        Some(Viewport::new(gpu, renderer))
    }

    /// Returns whether pipelines are being created, with the last picture shown meanwhile.
    pub(super) fn is_loading(&self) -> bool {
        self.renderer_loader.is_loading()
    }

    /// Releases all pictures from the index `first` on.
    pub(super) fn release_from(&mut self, first: usize, render: &RenderState) {
        let released = self.screens.drain(first.min(self.screens.len())..).flatten();
        for (id, _) in released.filter_map(|screen| screen.texture) {
            render.renderer.write().free_texture(&id);
        }
    }

    /// Draws one picture if it has changed, and returns its texture, if there is one yet.
    ///
    /// # Errors
    /// A sentence, where it cannot be drawn.
    pub(super) fn refresh(
        &mut self,
        at: usize,
        ui: &Ui,
        rect: Rect,
        gpu: &Arc<Gpu>,
        render: &RenderState,
        request: &PictureRequest<'_>,
    ) -> Result<Option<TextureId>, String> {
        let scale = ui.ctx().pixels_per_point();
        let size = [rect.width(), rect.height()].map(|side| (side * scale).round().max(1.0) as u32);
        // The last picture stays until the pipelines of the next one are created.
        let has_drawn = match self.is_ready(at, ui.ctx(), gpu, request)? {
            true => self.draw(at, gpu, request, size).map_err(|error| error.to_string())?,
            false => false,
        };
        if has_drawn {
            self.drawn += u64::from(at < FIRST_BESIDE);
            tracing::debug!(drawn = self.drawn, "the model was drawn");
            ui.ctx().request_repaint();
        }
        let screen = self.screens.get_mut(at).and_then(Option::as_mut);
        Ok(screen.and_then(|screen| screen.texture_id(render)))
    }

    /// Returns whether the pipelines of a picture are created; starts creating them otherwise.
    fn is_ready(
        &mut self,
        at: usize,
        context: &Context,
        gpu: &Arc<Gpu>,
        request: &PictureRequest<'_>,
    ) -> Result<bool, String> {
        let Some(renderer) = self.renderer_loader.renderer(context, gpu)? else {
            return Ok(false);
        };
        if self.screens.len() <= at {
            self.screens.resize_with(at + 1, || None);
        }
        let screen = self.screens[at].get_or_insert_with(|| ScreenPicture {
            viewport: Viewport::new(gpu, renderer.clone()),
            texture: None,
        });
        let Some(environment) = request.lighting.environment else {
            return Ok(false);
        };
        let scene = request.lighting.scene(request.picture, environment);
        let missing = screen.viewport.missing(&scene, &request.shot);
        self.renderer_loader.is_ready(context, gpu, &renderer, missing)
    }

    /// Draws one picture of a size in pixels if it has changed. Returns whether it had.
    pub(super) fn draw(
        &mut self,
        at: usize,
        gpu: &Arc<Gpu>,
        request: &PictureRequest<'_>,
        size: [u32; 2],
    ) -> Result<bool, EngineError> {
        let screen = self.screens.get_mut(at).and_then(Option::as_mut);
        let (Some(environment), Some(screen)) = (request.lighting.environment, screen) else {
            return Ok(false);
        };
        let scene = request.lighting.scene(request.picture, environment);
        // The revision also changes with the environment and the lights.
        let revision = request.lighting.revision_of(request.picture);
        let viewport = &mut screen.viewport;
        Ok(viewport.show(gpu, &scene, &revision, &request.shot, size, request.is_moving)?)
    }
}

impl ScreenPicture {
    /// Texture of the picture in the window; `None` before the first picture.
    fn texture_id(&mut self, render: &RenderState) -> Option<TextureId> {
        let shown = self.viewport.picture()?.texture().clone();
        if let Some((id, known)) = &self.texture
            && *known == shown
        {
            return Some(*id);
        }
        let view = shown.create_view(&wgpu::TextureViewDescriptor::default());
        let mut renderer = render.renderer.write();
        let filter = wgpu::FilterMode::Linear;
        let id = match &self.texture {
            Some((id, _)) => {
                renderer.update_egui_texture_from_wgpu_texture(&render.device, &view, filter, *id);
                *id
            }
            None => renderer.register_native_texture(&render.device, &view, filter),
        };
        self.texture = Some((id, shown));
        Some(id)
    }
}
