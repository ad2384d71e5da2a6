//! A graph on a model, looked at.

use std::path::Path;

use sabi_engine::evaluating::{ModelLooks, evaluate_looks};
use sabi_engine::phases::NoProgress;
use sabi_view::{
    Camera, Environment, Light, MaterialLook, Panorama, Pixels, Placement, RenderTarget, Renderer, Scene, Shot,
    ViewModel, Viewpoint,
};

use crate::OnMesh;

/// A graph on a model with all that it takes to draw it.
pub struct DrawableGraph {
    /// The graph on the model.
    pub on_mesh: OnMesh,
    /// Looks of the outputs.
    pub shown: ModelLooks,
    /// The model.
    pub model: ViewModel,
    /// Light from all around.
    pub environment: Environment,
    /// Lights besides it.
    pub lights: Vec<Light>,
    renderer: Renderer,
}

/// The same light from everywhere.
pub fn even_light(radiance: f32) -> Panorama {
    Panorama::new(2, 1, &[[radiance, radiance, radiance, 1.0]; 2])
        .expect("a panorama")
        .0
}

impl DrawableGraph {
    /// A graph on a model with `size` texels for one unit of UV, in the light of a panorama.
    pub fn new(graph: &str, mesh: &Path, size: u32, light: &Panorama) -> DrawableGraph {
        DrawableGraph::of(OnMesh::new(graph, mesh, size), light)
    }

    /// A graph that is on a model already, in the light of a panorama.
    pub fn of(mut on_mesh: OnMesh, light: &Panorama) -> DrawableGraph {
        let shown = evaluate_looks(&mut on_mesh.evaluator, None, &NoProgress).unwrap_or_else(|error| panic!("{error}"));
        let evaluator = &on_mesh.evaluator;
        let gpu = evaluator.gpu();
        let model = ViewModel::new(gpu, evaluator.view_parts());
        DrawableGraph {
            model: model.expect("a model"),
            environment: Environment::new(gpu, light).expect("an environment"),
            renderer: Renderer::new(gpu).expect("a renderer"),
            lights: Vec::new(),
            shown,
            on_mesh,
        }
    }

    /// A model whose materials all look alike.
    pub fn looking(mesh: &Path, look: &MaterialLook, light: &Panorama) -> DrawableGraph {
        let mut pictured = DrawableGraph::new(BARE, mesh, 32, light);
        pictured.set_look(look);
        pictured
    }

    /// Shows a node's own result, or a node's material, on all of the model.
    pub fn show_node(&mut self, node: &str) {
        let target = self.on_mesh.target(node);
        let shown = evaluate_looks(&mut self.on_mesh.evaluator, Some(&target), &NoProgress);
        self.shown = shown.unwrap_or_else(|error| panic!("{node}: {error}"));
    }

    /// Gives all materials one look.
    pub fn set_look(&mut self, look: &MaterialLook) {
        self.shown.looks = vec![look.clone()];
        self.shown.look_of_material.fill(0);
    }

    /// A camera at a viewpoint that sees all of the model.
    pub fn camera(&self, viewpoint: Viewpoint, [width, height]: [u32; 2]) -> Camera {
        let mesh = &self.on_mesh.evaluator.linked().model.mesh;
        let points = Placement::of(mesh).points_in_view(mesh);
        Camera::seen_from(viewpoint, &points, width as f32 / height as f32)
    }

    /// Scene with the model, its looks and its lights.
    pub fn scene(&self) -> Scene<'_> {
        Scene {
            model: &self.model,
            looks: &self.shown.looks,
            look_of_material: &self.shown.look_of_material,
            environment: &self.environment,
            lights: &self.lights,
        }
    }

    /// Draws, and hands over what it was drawn into.
    pub fn draw(&self, shot: &Shot, size: [u32; 2]) -> RenderTarget {
        let gpu = self.on_mesh.evaluator.gpu();
        let scene = self.scene();
        let mut target = RenderTarget::new(gpu, size).unwrap_or_else(|error| panic!("{error}"));
        let drawn = self.renderer.draw(gpu, &mut target, &scene, shot);
        drawn.unwrap_or_else(|error| panic!("{error}"));
        target
    }

    /// The light of a picture: linear RGB and cover.
    pub fn light(&self, shot: &Shot, size: [u32; 2]) -> Vec<[f32; 4]> {
        self.draw(shot, size)
            .read_light(self.on_mesh.evaluator.gpu())
            .expect("light")
    }

    /// The picture.
    pub fn pixels(&self, shot: &Shot, size: [u32; 2]) -> Pixels {
        self.draw(shot, size)
            .read(self.on_mesh.evaluator.gpu())
            .expect("pixels")
    }
}

/// A graph that shows a plain material.
const BARE: &str = r#"{ "format": "sabi", "version": 1, "name": "bare", "nodes": {
    "plain": { "kind": "source/material" },
    "out": { "kind": "output/material", "inputs": { "material": "plain" } } } }"#;
