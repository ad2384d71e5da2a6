//! A model on the device, as it is drawn.

#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::ops::Range;

use sabi_gpu::wgsl_struct;
use sabi_gpu::{Gpu, GpuSurface};
use sabi_surface::atlas::Atlas;
use sabi_surface::displace::Displaced;
use sabi_surface::model::{Mesh, Model};

use crate::edges::{Line, Side, lines_of, sides_of, sides_of_displaced};
use crate::error::ViewError;
use crate::placement::Placement;
use crate::upload::{buffer_of, table_of};

wgsl_struct! {
    vertex "view/corner" Corner:
    /// Corner of a triangle.
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
            made.end_part();
        }
        made
    }

    /// The corners of a displaced copy of a model: as many as it has vertices, since each of those lies on one chart.
    pub(crate) fn of_displaced(displaced: &Displaced, model: &Model, atlas: &Atlas, placement: &Placement) -> Corners {
        let material = |triangle: usize| model.mesh.triangle_material[displaced.triangle_from[triangle] as usize];
        let mut order: Vec<u32> = (0..displaced.triangles.len() as u32).collect();
        order.sort_by_key(|&triangle| material(triangle as usize));
        let mut charts = vec![0; displaced.positions.len()];
        for (corners, &from) in displaced.triangles.iter().zip(&displaced.triangle_from) {
            for &corner in corners {
                charts[corner as usize] = atlas.triangle_chart[from as usize];
            }
        }
        let corner = |(vertex, &chart): (usize, &u32)| Corner {
            position: placement.view_from_model(displaced.positions[vertex]).to_array(),
            normal: displaced.normals[vertex],
            tangent: displaced.tangents[vertex],
            texel: displaced.texels[vertex],
            chart,
        };
        let mut made = Corners {
            corners: charts.iter().enumerate().map(corner).collect(),
            indices: Vec::with_capacity(3 * order.len()),
            parts: Vec::new(),
        };
        for triangle in order {
            let triangle = triangle as usize;
            made.part_of(model, material(triangle));
            made.indices.extend(displaced.triangles[triangle]);
            made.end_part();
        }
        made
    }

    /// Ends the current part at the last index so far.
    fn end_part(&mut self) {
        if let Some(part) = self.parts.last_mut() {
            part.indices.end = self.indices.len() as u32;
        }
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
        // A mesh without tangents has no normal map that would need them.
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
    /// For each chart, the shift from texture coordinates in texels to texels on its page, and the page.
    pub(crate) charts: wgpu::TextureView,
    /// All edges, and those that are seams.
    pub(crate) edges: [(wgpu::Buffer, u32); 2],
    pub(crate) texels_of_uv: f32,
    /// Texels along a unit of view space that half of the surface has more than.
    pub(crate) even_density: f32,
    /// Placement of the model in view space.
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
        let made = Corners::of(model, atlas, &Placement::of(&model.mesh));
        let sides = sides_of(&model.mesh, atlas);
        ViewModel::upload(gpu, model, atlas, surface, model_from_working, (made, sides))
    }

    /// Uploads a displaced copy in place of the model that it was made from, which is what says where it is put. Lines over
    /// it are the edges and seams of the model, lifted with the heights.
    pub fn displaced(
        gpu: &Gpu,
        displaced: &Displaced,
        model: &Model,
        atlas: &Atlas,
        surface: &GpuSurface,
        model_from_working: f64,
    ) -> Result<ViewModel, ViewError> {
        let made = Corners::of_displaced(displaced, model, atlas, &Placement::of(&model.mesh));
        let sides = sides_of_displaced(displaced, atlas);
        ViewModel::upload(gpu, model, atlas, surface, model_from_working, (made, sides))
    }

    fn upload(
        gpu: &Gpu,
        model: &Model,
        atlas: &Atlas,
        surface: &GpuSurface,
        model_from_working: f64,
        (made, sides): (Corners, Vec<Side>),
    ) -> Result<ViewModel, ViewError> {
        let placement = Placement::of(&model.mesh);
        let lines = |lines: &[Line]| -> Result<(wgpu::Buffer, u32), ViewError> {
            let usage = wgpu::BufferUsages::VERTEX;
            let buffer = buffer_of(gpu, "the edges of the model", usage, bytemuck::cast_slice(lines))?;
            Ok((buffer, lines.len() as u32))
        };
        let [edges, seams] = lines_of(sides, &placement);
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
            edges: [lines(&edges)?, lines(&seams)?],
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
