//! A model on the device, as it is drawn.

use std::collections::HashMap;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use sabi_gpu::{Gpu, GpuSurface};
use sabi_surface::atlas::Atlas;
use sabi_surface::model::{Mesh, Model};

use crate::edges::{Line, edges_of, seams_of};
use crate::error::ViewError;
use crate::placement::Placement;
use crate::upload::{buffer_of, table_of};

/// A corner, as `model.wgsl` reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Corner {
    /// View space.
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
    /// With the sign of the bitangent.
    pub(crate) tangent: [f32; 4],
    /// Texel coordinates on the chart's page.
    pub(crate) texel: [f32; 2],
    pub(crate) chart: u32,
}

/// Triangles of one material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) material: u32,
    pub(crate) is_double_sided: bool,
    /// Among the indices.
    pub(crate) indices: Range<u32>,
}

/// A model as it is drawn, in memory.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Corners {
    pub(crate) corners: Vec<Corner>,
    /// Three a triangle, material after material.
    pub(crate) indices: Vec<u32>,
    pub(crate) parts: Vec<Part>,
}

impl Corners {
    /// The corners of a model: those of one vertex that lie on one chart are one.
    pub(crate) fn of(model: &Model, atlas: &Atlas, placement: &Placement) -> Corners {
        let mesh = &model.mesh;
        let mut order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        order.sort_by_key(|&triangle| mesh.triangle_material[triangle as usize]);
        let mut made = Corners {
            corners: Vec::with_capacity(mesh.positions.len()),
            indices: Vec::with_capacity(3 * order.len()),
            parts: Vec::new(),
        };
        let mut known: HashMap<(u32, u32), u32> = HashMap::with_capacity(mesh.positions.len());
        for triangle in order {
            let triangle = triangle as usize;
            made.part_of(model, mesh.triangle_material[triangle]);
            let chart = atlas.triangle_chart[triangle];
            for (vertex, texel) in mesh.triangles[triangle]
                .into_iter()
                .zip(atlas.triangle_texels[triangle])
            {
                let index = *known.entry((vertex, chart)).or_insert_with(|| {
                    made.corners.push(corner(mesh, placement, vertex, texel, chart));
                    made.corners.len() as u32 - 1
                });
                made.indices.push(index);
            }
            if let Some(part) = made.parts.last_mut() {
                part.indices.end = made.indices.len() as u32;
            }
        }
        made
    }

    /// Begins the triangles of another material.
    fn part_of(&mut self, model: &Model, material: u32) {
        if self.parts.last().is_some_and(|part| part.material == material) {
            return;
        }
        let of_material = model.materials.get(material as usize);
        let start = self.indices.len() as u32;
        self.parts.push(Part {
            material,
            is_double_sided: of_material.is_none_or(|material| material.is_double_sided),
            indices: start..start,
        });
    }
}

fn corner(mesh: &Mesh, placement: &Placement, vertex: u32, texel: [f32; 2], chart: u32) -> Corner {
    let vertex = vertex as usize;
    Corner {
        position: placement.view_from_model(mesh.positions[vertex]).to_array(),
        normal: mesh.normals[vertex],
        tangent: mesh.tangents.get(vertex).copied().unwrap_or([1.0, 0.0, 0.0, 1.0]),
        texel,
        chart,
    }
}

/// A model on the device, as it is drawn.
pub struct ViewModel {
    pub(crate) corners: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) parts: Vec<Part>,
    pub(crate) index_count: u32,
    /// The surface that its relief is followed on.
    pub(crate) surface: wgpu::BindGroup,
    /// View units in a working unit.
    pub(crate) view_from_working: f32,
    /// What every chart's texel coordinates mean.
    pub(crate) charts: wgpu::TextureView,
    /// All edges, and those that are seams.
    pub(crate) edges: [(wgpu::Buffer, u32); 2],
    pub(crate) texels_of_uv: f32,
    /// Texels along a unit of view space that half of the surface has more than.
    pub(crate) even_density: f32,
    /// Where the model is put.
    pub placement: Placement,
}

impl ViewModel {
    /// Uploads a model as its atlas has it. `surface` is the atlas on the device, with lengths of which one is so many model
    /// units.
    pub fn new(
        gpu: &Gpu,
        model: &Model,
        atlas: &Atlas,
        surface: &GpuSurface,
        model_from_working: f64,
    ) -> Result<ViewModel, ViewError> {
        let placement = Placement::of(&model.mesh);
        let made = Corners::of(model, atlas, &placement);
        let lines = |lines: Vec<Line>| -> Result<(wgpu::Buffer, u32), ViewError> {
            let count = lines.len() as u32;
            let usage = wgpu::BufferUsages::VERTEX;
            Ok((
                buffer_of(gpu, "the edges of the model", usage, bytemuck::cast_slice(&lines))?,
                count,
            ))
        };
        let rows: Vec<[f32; 4]> = atlas.charts.iter().map(chart_row).collect();
        Ok(ViewModel {
            corners: buffer_of(
                gpu,
                "the corners of the model",
                wgpu::BufferUsages::VERTEX,
                bytemuck::cast_slice(&made.corners),
            )?,
            indices: buffer_of(
                gpu,
                "the triangles of the model",
                wgpu::BufferUsages::INDEX,
                bytemuck::cast_slice(&made.indices),
            )?,
            index_count: made.indices.len() as u32,
            parts: made.parts,
            surface: gpu.surface_bindings(surface),
            view_from_working: (model_from_working * placement.scale) as f32,
            charts: table_of(gpu, "the charts of the model", &rows)?,
            edges: [
                lines(edges_of(&model.mesh, &placement))?,
                lines(seams_of(&model.mesh, atlas, &placement))?,
            ],
            texels_of_uv: atlas.size as f32,
            even_density: even_density(&model.mesh, atlas, &placement),
            placement,
        })
    }
}

fn chart_row(chart: &sabi_surface::atlas::Chart) -> [f32; 4] {
    let [u, v] = chart.texel_from_uv;
    [u as f32, v as f32, chart.page as f32, 0.0]
}

/// Texels along a unit of view space, the median over the surface by area.
fn even_density(mesh: &Mesh, atlas: &Atlas, placement: &Placement) -> f32 {
    let mut densities: Vec<(f64, f64)> = Vec::with_capacity(mesh.triangles.len());
    for (triangle, texels) in mesh.triangles.iter().zip(&atlas.triangle_texels) {
        let corner = |at: usize| {
            placement
                .view_from_model(mesh.positions[triangle[at] as usize])
                .as_dvec3()
        };
        let texel = |at: usize| glam::Vec2::from(texels[at]).as_dvec2();
        let area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).length();
        let covered = (texel(1) - texel(0)).perp_dot(texel(2) - texel(0)).abs();
        if area > 0.0 && covered > 0.0 {
            densities.push(((covered / area).sqrt(), area));
        }
    }
    densities.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = densities.iter().map(|(_, area)| area).sum::<f64>() / 2.0;
    let mut sum = 0.0;
    let median = densities.iter().find(|(_, area)| {
        sum += area;
        sum >= half
    });
    median.map_or(1.0, |(density, _)| *density as f32)
}
