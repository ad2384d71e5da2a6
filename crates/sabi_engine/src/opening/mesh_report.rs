//! Report on a model and its atlas for `sabi mesh` and the report of a bake; docs/report.md lists the keys.

use sabi_export::set_names;
use sabi_surface::model::{Model, UvDecoding};
use sabi_surface::orientation::turned_faces;
use schemars::JsonSchema;
use serde::Serialize;

use crate::opening::linked_model::{LinkedModel, UnwrapResult};
use crate::opening::overlap::{OverlapReport, OverlapTotals, SetReport};
use crate::warning::Warning;

/// A model and its atlas.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MeshReport {
    /// Triangles of all parts.
    pub triangles: usize,
    /// Vertices after welding.
    pub vertices: usize,
    /// Names of the model's parts.
    pub parts: Vec<String>,
    /// Names of the parts of the file that were left out.
    pub parts_left_out: Vec<String>,
    /// Connected pieces of all parts.
    pub pieces: usize,
    /// Names of the materials, as used in file names.
    pub materials: Vec<String>,
    /// Results of unwrapping the model; `None` if its own UVs are used.
    pub unwrapped: Option<UnwrappingReport>,
    /// UVs that the file stores under a transform.
    pub decoded_uvs: Vec<DecodedUvs>,
    /// Angle between faces up to which the shading was smoothed, degrees; `None` for the normals of the file.
    pub smooth_degrees: Option<f32>,
    /// Number of faces that were turned because they were inside out.
    pub turned_faces: usize,
    /// Faces that are inside out.
    pub inside_out_faces: usize,
    /// True if vertices have colors.
    pub vertex_colors: bool,
    /// Largest side of the bounding box, model units.
    pub largest_side: f32,
    /// Texels for one unit of UV.
    pub size: u32,
    /// Pages of the atlas.
    pub pages: u32,
    /// Width and height of a page, texels.
    pub page_size: [u32; 2],
    /// Charts in UV. A chart that overlaps itself counts as the parts that do not.
    pub charts: usize,
    /// Share of the atlas that charts cover.
    pub coverage: f32,
    /// Charts that share places on the maps.
    pub overlap: OverlapReport,
    /// Texture sets for which a bake makes maps.
    pub sets: Vec<SetReport>,
    /// Pairs of charts that share places.
    pub overlapping_charts: usize,
    /// Number of charts that are exactly on an earlier one.
    pub stacked_charts: u32,
    /// Charts whose UVs are mirrored.
    pub mirrored_charts: u32,
    /// Number of charts whose place in the atlas differs from that of their UVs.
    pub moved_charts: u32,
    /// Charts thinner than two texels.
    pub thin_charts: u32,
    /// Triangles without area.
    pub degenerate_triangles: u32,
    /// Triangles without area in UV.
    pub degenerate_uv_triangles: u32,
    /// Edges with more than two triangles.
    pub nonmanifold_edges: u32,
    /// Edges with one triangle.
    pub border_edges: u32,
    /// Texels of the rings around charts.
    pub ghost_texels: usize,
    /// Ghosts without a link across a seam.
    pub unlinked_ghosts: u32,
    /// Warnings for the artist, as sentences with their remedies.
    #[schemars(with = "Vec<String>")]
    pub warnings: Vec<Warning>,
}

/// UVs of a material that the file stores under a transform: `uv = stored × scale + offset`.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct DecodedUvs {
    /// Name of the material, as used in file names.
    pub material: String,
    /// Factor of u and v.
    pub scale: [f32; 2],
    /// Summand of u and v.
    pub offset: [f32; 2],
}

impl DecodedUvs {
    /// Lists the materials whose stored UVs were decoded; empty if the whole model was unwrapped.
    pub(crate) fn of(linked: &LinkedModel) -> Vec<DecodedUvs> {
        if linked.model.mesh.is_one_sheet {
            return Vec::new();
        }
        let materials = linked.model.materials.iter().zip(set_names(&linked.model));
        let decoded = materials.filter_map(|(material, name)| {
            let UvDecoding { scale, offset } = material.uv_decoding?;
            Some(DecodedUvs {
                material: name,
                scale,
                offset,
            })
        });
        decoded.collect()
    }
}

/// Results of unwrapping a model.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct UnwrappingReport {
    /// `TEXCOORD` of the new UVs in a copy of the model.
    pub uv_set: u32,
    /// Connected pieces.
    pub pieces: u32,
    /// Pieces that are not copies of another.
    pub distinct_pieces: u32,
    /// Charts on the sheet.
    pub charts: u32,
    /// Share of the sheet that triangles cover.
    pub coverage: f32,
    /// Longest direction of a triangle divided by its shortest, averaged by area; 1 means no stretch.
    pub stretch: f32,
    /// The worst value of the same, among the triangles with 99.9 % of the area.
    pub worst_stretch: f32,
    /// Texels between charts.
    pub gap_texels: f32,
}

impl UnwrappingReport {
    /// Describes the unwrapping of a model for maps of `size` × `size` texels.
    pub(crate) fn of(unwrapping: &UnwrapResult, size: u32) -> UnwrappingReport {
        let report = &unwrapping.report;
        let [pieces, distinct_pieces] = report.pieces;
        UnwrappingReport {
            uv_set: unwrapping.uv_set,
            pieces,
            distinct_pieces,
            charts: report.charts,
            coverage: report.coverage,
            stretch: report.stretch,
            worst_stretch: report.worst_stretch,
            gap_texels: report.gap_at(size),
        }
    }
}

/// Lists the parts of a file that its model does not have.
pub(crate) fn parts_left_out(model: &Model) -> Vec<String> {
    let left_out = model.file_parts.iter().filter(|part| part.left_out.is_some());
    left_out.map(|part| part.name.clone()).collect()
}

/// Describes a model and its atlas.
pub fn describe_mesh(linked: &LinkedModel) -> MeshReport {
    let (mesh, report) = (&linked.model.mesh, &linked.atlas.report);
    let unwrapped = linked.unwrapped.as_ref();
    let overlap = OverlapTotals::of(linked);
    MeshReport {
        triangles: mesh.triangles.len(),
        vertices: mesh.positions.len(),
        parts: linked.model.parts.clone(),
        parts_left_out: parts_left_out(&linked.model),
        pieces: linked.pieces.boxes.len(),
        materials: set_names(&linked.model),
        unwrapped: unwrapped.map(|unwrapping| UnwrappingReport::of(unwrapping, linked.atlas.size)),
        decoded_uvs: DecodedUvs::of(linked),
        smooth_degrees: linked.smooth_degrees,
        turned_faces: linked.model.turned_faces,
        inside_out_faces: turned_faces(mesh).len(),
        vertex_colors: !mesh.colors.is_empty(),
        largest_side: linked.largest_side as f32,
        size: linked.atlas.size,
        pages: linked.atlas.pages,
        page_size: linked.atlas.page_size,
        charts: linked.atlas.uv_charts().len(),
        coverage: report.coverage,
        overlap: overlap.report(linked),
        sets: overlap.sets(linked),
        overlapping_charts: report.overlapping_charts.len(),
        stacked_charts: report.stacked_charts,
        mirrored_charts: report.mirrored_charts,
        moved_charts: report.moved_charts,
        thin_charts: report.thin_charts,
        degenerate_triangles: report.degenerate_triangles,
        degenerate_uv_triangles: report.degenerate_uv_triangles,
        nonmanifold_edges: report.nonmanifold_edges,
        border_edges: report.border_edges,
        ghost_texels: linked.atlas.ghosts.len(),
        unlinked_ghosts: report.unlinked_ghosts,
        warnings: linked.warnings(),
    }
}
