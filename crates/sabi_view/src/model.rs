//! Models on the device.

#[cfg(test)]
mod tests;

use std::collections::HashMap;
use std::ops::Range;
use std::sync::OnceLock;

use sabi_gpu::{Gpu, GpuSurface};
use sabi_nodes::wgsl_struct;
use sabi_surface::atlas::Atlas;
use sabi_surface::displace::DisplacedMesh;
use sabi_surface::ground::Ground as ModelGround;
use sabi_surface::model::{Mesh, Model};
use sabi_surface::openness::Openness as ModelOpenness;

use crate::edges::{HalfEdge, Line, displaced_half_edges, half_edges, lines};
use crate::error::ViewError;
use crate::placement::Placement;
use crate::shade::{GroundShade, OpennessTextures, Shade};
use crate::upload::{buffer_of, table_of};

wgsl_struct! {
    vertex "view/corner" Corner:
    /// Vertex of the drawn model.
    pub(crate) struct Vertex {
        /// Position in view space.
        pub(crate) position: [f32; 3],
        pub(crate) normal: [f32; 3],
        /// Tangent, with the sign of the bitangent as the fourth component.
        pub(crate) tangent: [f32; 4],
        /// Texel coordinates on the chart's page.
        pub(crate) texel: [f32; 2],
        pub(crate) chart: u32,
    }
}

/// Triangles of one material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MaterialRange {
    pub(crate) material: u32,
    pub(crate) is_double_sided: bool,
    /// Range of the indices.
    pub(crate) indices: Range<u32>,
}

/// Vertices and indices of a drawn model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawMesh {
    pub(crate) vertices: Vec<Vertex>,
    /// Three indices per triangle, sorted by material.
    pub(crate) indices: Vec<u32>,
    pub(crate) ranges: Vec<MaterialRange>,
}

impl DrawMesh {
    /// Returns the mesh of a model. A vertex of the model that is on several charts becomes one vertex for each chart.
    pub(crate) fn of(model: &Model, atlas: &Atlas, placement: &Placement) -> DrawMesh {
        let mesh = &model.mesh;
        let mut order: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        order.sort_by_key(|&triangle| mesh.triangle_material[triangle as usize]);
        let mut made = DrawMesh {
            vertices: Vec::with_capacity(mesh.positions.len()),
            indices: Vec::with_capacity(3 * order.len()),
            ranges: Vec::new(),
        };
        let mut known: HashMap<(u32, u32), u32> = HashMap::with_capacity(mesh.positions.len());
        for triangle in order {
            let triangle = triangle as usize;
            made.begin_range(model, mesh.triangle_material[triangle]);
            let chart = atlas.triangle_chart[triangle];
            for (vertex, texel) in mesh.triangles[triangle]
                .into_iter()
                .zip(atlas.triangle_texels[triangle])
            {
                let index = *known.entry((vertex, chart)).or_insert_with(|| {
                    made.vertices.push(vertex_of(mesh, placement, vertex, texel, chart));
                    made.vertices.len() as u32 - 1
                });
                made.indices.push(index);
            }
            made.end_range();
        }
        made
    }

    /// Returns the mesh of a displaced copy of a model. Each vertex of the copy is on one chart.
    pub(crate) fn of_displaced(
        displaced: &DisplacedMesh,
        model: &Model,
        atlas: &Atlas,
        placement: &Placement,
    ) -> DrawMesh {
        let material = |triangle: usize| model.mesh.triangle_material[displaced.triangle_from[triangle] as usize];
        let mut order: Vec<u32> = (0..displaced.triangles.len() as u32).collect();
        order.sort_by_key(|&triangle| material(triangle as usize));
        let mut charts = vec![0; displaced.positions.len()];
        for (corners, &from) in displaced.triangles.iter().zip(&displaced.triangle_from) {
            for &corner in corners {
                charts[corner as usize] = atlas.triangle_chart[from as usize];
            }
        }
        let displaced_vertex = |(vertex, &chart): (usize, &u32)| Vertex {
            position: placement.view_from_model(displaced.positions[vertex]).to_array(),
            normal: displaced.normals[vertex],
            tangent: displaced.tangents[vertex],
            texel: displaced.texels[vertex],
            chart,
        };
        let mut made = DrawMesh {
            vertices: charts.iter().enumerate().map(displaced_vertex).collect(),
            indices: Vec::with_capacity(3 * order.len()),
            ranges: Vec::new(),
        };
        for triangle in order {
            let triangle = triangle as usize;
            made.begin_range(model, material(triangle));
            made.indices.extend(displaced.triangles[triangle]);
            made.end_range();
        }
        made
    }

    /// Ends the last range at the present end of the indices.
    fn end_range(&mut self) {
        if let Some(range) = self.ranges.last_mut() {
            range.indices.end = self.indices.len() as u32;
        }
    }

    /// Begins a range of triangles of a material, unless the last range has the same material.
    fn begin_range(&mut self, model: &Model, material: u32) {
        if self.ranges.last().is_some_and(|range| range.material == material) {
            return;
        }
        let of_material = model.materials.get(material as usize);
        let start = self.indices.len() as u32;
        self.ranges.push(MaterialRange {
            material,
            is_double_sided: of_material.is_none_or(|material| material.is_double_sided),
            indices: start..start,
        });
    }
}

fn vertex_of(mesh: &Mesh, placement: &Placement, vertex: u32, texel: [f32; 2], chart: u32) -> Vertex {
    let vertex = vertex as usize;
    Vertex {
        position: placement.view_from_model(mesh.positions[vertex]).to_array(),
        normal: mesh.normals[vertex],
        // A mesh without tangents has no normal map that would need them, so any tangent is used.
        tangent: mesh.tangents.get(vertex).copied().unwrap_or([1.0, 0.0, 0.0, 1.0]),
        texel,
        chart,
    }
}

/// Model on the device, ready to be drawn.
pub struct ViewModel {
    pub(crate) vertices: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    pub(crate) ranges: Vec<MaterialRange>,
    pub(crate) index_count: u32,
    /// Bind group of the surface, for relief.
    pub(crate) surface: wgpu::BindGroup,
    /// View units per working unit.
    pub(crate) view_from_working: f32,
    /// For each chart, its page and the offset from texture coordinates in texels to texels on the page.
    pub(crate) charts: wgpu::TextureView,
    /// Lines along all edges, and lines along the seams, each with the number of lines.
    pub(crate) edges: [(wgpu::Buffer, u32); 2],
    pub(crate) texels_of_uv: f32,
    /// Texels per unit of view space: the median over the surface by area.
    pub(crate) median_density: f32,
    /// Shade of the model, once it has been computed.
    pub(crate) shade: OnceLock<Shade>,
    /// Placement of the model in view space.
    pub placement: Placement,
}

/// Parts from which a model on the device is created.
#[derive(Clone, Copy)]
pub struct ViewModelParts<'a> {
    /// The model.
    pub model: &'a Model,
    /// Its atlas.
    pub atlas: &'a Atlas,
    /// The atlas on the device.
    pub surface: &'a GpuSurface,
    /// Factor from working units of the surface to model units.
    pub model_from_working: f64,
}

impl ViewModel {
    /// Uploads a model with the charts of its atlas.
    pub fn new(gpu: &Gpu, parts: ViewModelParts<'_>) -> Result<ViewModel, ViewError> {
        let ViewModelParts { model, atlas, .. } = parts;
        let made = DrawMesh::of(model, atlas, &Placement::of(&model.mesh));
        ViewModel::upload(gpu, parts, made, half_edges(&model.mesh, atlas))
    }

    /// Uploads a displaced copy of a model, with the placement of the model. Lines are drawn along the displaced edges and
    /// seams of the model.
    pub fn displaced(gpu: &Gpu, displaced: &DisplacedMesh, parts: ViewModelParts<'_>) -> Result<ViewModel, ViewError> {
        let ViewModelParts { model, atlas, .. } = parts;
        let made = DrawMesh::of_displaced(displaced, model, atlas, &Placement::of(&model.mesh));
        ViewModel::upload(gpu, parts, made, displaced_half_edges(displaced, atlas))
    }

    /// Adds the shade of the model on the ground and on itself. It is added later since computing it takes longer than a
    /// first picture should. Further calls have no effect.
    pub fn set_shade(
        &self,
        gpu: &Gpu,
        ground: Option<&ModelGround>,
        openness: Option<&ModelOpenness>,
    ) -> Result<(), ViewError> {
        if self.shade.get().is_none() {
            let ground = ground
                .map(|ground| GroundShade::new(gpu, ground, &self.placement))
                .transpose()?;
            let openness = openness
                .map(|openness| OpennessTextures::new(gpu, openness))
                .transpose()?;
            self.shade.get_or_init(|| Shade { ground, openness });
        }
        Ok(())
    }

    /// Returns true if the shade of the model was added.
    pub fn has_shade(&self) -> bool {
        self.shade.get().is_some()
    }

    /// Returns the ground below the model, once it has been computed.
    pub(crate) fn ground(&self) -> Option<&GroundShade> {
        self.shade.get()?.ground.as_ref()
    }

    /// Returns the openness of the model's surface, once it has been computed.
    pub(crate) fn openness(&self) -> Option<&OpennessTextures> {
        self.shade.get()?.openness.as_ref()
    }

    fn upload(
        gpu: &Gpu,
        ViewModelParts {
            model,
            atlas,
            surface,
            model_from_working,
        }: ViewModelParts<'_>,
        mesh: DrawMesh,
        half_edges: Vec<HalfEdge>,
    ) -> Result<ViewModel, ViewError> {
        let placement = Placement::of(&model.mesh);
        let line_buffer = |lines: &[Line]| -> Result<(wgpu::Buffer, u32), ViewError> {
            let usage = wgpu::BufferUsages::VERTEX;
            let buffer = buffer_of(gpu, "the edges of the model", usage, bytemuck::cast_slice(lines))?;
            Ok((buffer, lines.len() as u32))
        };
        let [edges, seams] = lines(half_edges, &placement);
        let rows: Vec<[f32; 4]> = atlas.charts.iter().map(chart_row).collect();
        Ok(ViewModel {
            vertices: buffer_of(
                gpu,
                "the vertices of the model",
                wgpu::BufferUsages::VERTEX,
                bytemuck::cast_slice(&mesh.vertices),
            )?,
            indices: buffer_of(
                gpu,
                "the triangles of the model",
                wgpu::BufferUsages::INDEX,
                bytemuck::cast_slice(&mesh.indices),
            )?,
            index_count: mesh.indices.len() as u32,
            ranges: mesh.ranges,
            surface: surface.bindings(gpu),
            view_from_working: (model_from_working * placement.scale) as f32,
            charts: table_of(gpu, "the charts of the model", &rows)?,
            edges: [line_buffer(&edges)?, line_buffer(&seams)?],
            texels_of_uv: atlas.size as f32,
            median_density: median_density(&model.mesh, atlas, &placement),
            shade: OnceLock::new(),
            placement,
        })
    }
}

fn chart_row(chart: &sabi_surface::atlas::Chart) -> [f32; 4] {
    let [u, v] = chart.texel_from_uv;
    [u as f32, v as f32, chart.page as f32, 0.0]
}

/// Returns the texels per unit of view space: the median over the surface by area.
fn median_density(mesh: &Mesh, atlas: &Atlas, placement: &Placement) -> f32 {
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
