//! Pieces cut into charts and laid flat, by the crate `uvunwrap`.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::pieces::Piece;
use super::sheet::{area, flat_area};
use crate::model::Mesh;

/// Charts of pieces with more triangles than this are kept small: to lay one flat takes time that grows faster than it.
const LARGE: usize = 12_000;
/// About how many triangles a chart of a large piece has at most.
const CHART_TRIANGLES: f64 = 3_000.0;

/// Triangles laid flat together.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FlatChart {
    pub(super) triangles: Vec<u32>,
    /// Their corners in model units, counter-clockwise where u goes right and v goes down, that is as a picture is seen.
    pub(super) corners: Vec<[[f64; 2]; 3]>,
}

/// All charts of a mesh.
pub(super) struct Flattened {
    pub(super) charts: Vec<FlatChart>,
    /// Pieces that were worked out; the others are copies of those.
    pub(super) distinct: u32,
    /// Sentences about pieces that could not be laid flat as they are.
    pub(super) warnings: Vec<String>,
}

/// Lays all pieces flat, those that are alike once. Triangles without area are on no chart.
pub(super) fn flatten(mesh: &Mesh, pieces: &[Piece]) -> Flattened {
    let is_first = |&index: &usize| pieces[index].like.0 == index;
    let firsts: Vec<usize> = (0..pieces.len()).filter(is_first).collect();
    let worked_out: Vec<(Vec<LocalChart>, Option<String>)> = firsts
        .par_iter()
        .map(|&index| charts_of(mesh, &pieces[index]))
        .collect();
    let mut charts = Vec::new();
    let mut failed: BTreeMap<&str, usize> = BTreeMap::new();
    for piece in pieces {
        let (first, factor) = piece.like;
        let Ok(at) = firsts.binary_search(&first) else { continue };
        let (local, failure) = &worked_out[at];
        if let Some(reason) = failure {
            *failed.entry(reason).or_default() += 1;
        }
        charts.extend(local.iter().map(|(members, corners)| {
            FlatChart {
                triangles: members.iter().map(|&member| piece.triangles[member as usize]).collect(),
                corners: corners
                    .iter()
                    .map(|triangle| triangle.map(|corner| corner.map(|value| value * factor)))
                    .collect(),
            }
        }));
    }
    Flattened {
        charts,
        distinct: firsts.len() as u32,
        warnings: failed.iter().map(|(reason, &count)| torn(reason, count)).collect(),
    }
}

fn torn(reason: &str, count: usize) -> String {
    let pieces = if count == 1 { "piece" } else { "pieces" };
    format!(
        "{count} {pieces} could not be laid flat as a whole, so each triangle there is a chart of its own: {reason}"
    )
}

/// Places in a piece's list of triangles, and their corners.
type LocalChart = (Vec<u32>, Vec<[[f64; 2]; 3]>);

/// The charts of a piece, and why it was torn into its triangles if it was.
fn charts_of(mesh: &Mesh, piece: &Piece) -> (Vec<LocalChart>, Option<String>) {
    // A single triangle needs no solver; a model of a million loose triangles would need a million calls.
    if let [triangle] = piece.triangles[..] {
        return (one_by_one(mesh, &[triangle]), None);
    }
    match unwrapped(mesh, piece) {
        Ok(charts) => (charts, None),
        Err(reason) => (one_by_one(mesh, &piece.triangles), Some(reason)),
    }
}

fn unwrapped(mesh: &Mesh, piece: &Piece) -> Result<Vec<LocalChart>, String> {
    let positions: Vec<[f32; 3]> = piece
        .vertices
        .iter()
        .map(|&vertex| mesh.positions[vertex as usize])
        .collect();
    let (low, high) = positions
        .iter()
        .fold(([f32::MAX; 3], [f32::MIN; 3]), |(low, high), at| {
            (
                [0, 1, 2].map(|axis| low[axis].min(at[axis])),
                [0, 1, 2].map(|axis| high[axis].max(at[axis])),
            )
        });
    let side = [0, 1, 2].map(|axis| f64::from(high[axis]) - f64::from(low[axis]));
    let longest = side.into_iter().fold(0.0, f64::max);
    // In steps of the longest side, so that very small and very large models are the same to the solver.
    let scale = 1.0 / longest;
    let total: f64 = piece.triangles.iter().map(|&triangle| area(mesh, triangle)).sum();
    let count = piece.triangles.len();
    let limit = total * scale * scale * CHART_TRIANGLES / count as f64;
    let options = uvunwrap::Options {
        density: uvunwrap::Density::Fixed {
            texels_per_unit: TEXELS,
            page_size: None,
        },
        padding: 0,
        allow_rotation: false,
        packing: uvunwrap::Packing::Fast,
        max_chart_area: if count > LARGE { limit as f32 } else { 0.0 },
        ..uvunwrap::Options::default()
    };
    let input = uvunwrap::MeshInput {
        scale: scale as f32,
        ..uvunwrap::MeshInput::new(&positions, &piece.corners)
    };
    let found = uvunwrap::generate(&[input], &options).map_err(|error| error.to_string())?;
    let unit = 1.0 / (f64::from(TEXELS) * f64::from(scale as f32));
    let page = [f64::from(found.width) * unit, f64::from(found.height) * unit];
    let whole = found.meshes.first().and_then(|found| charts(mesh, piece, found, page));
    whole.ok_or_else(|| "the result has no place for some of its vertices".to_owned())
}

/// Resolution in which the crate hands over its charts, texels for the longest side of a piece; they are not rounded to it.
const TEXELS: f32 = 512.0;

/// The crate's result sorted by chart. Its triangles have a positive area in (u, v), which is clockwise in a picture.
fn charts(mesh: &Mesh, piece: &Piece, found: &uvunwrap::OutputMesh, page: [f64; 2]) -> Option<Vec<LocalChart>> {
    let mut by_chart: BTreeMap<u32, LocalChart> = BTreeMap::new();
    for (member, corners) in found.indices.as_chunks::<3>().0.iter().enumerate() {
        let vertices = corners.map(|corner| found.vertices.get(corner as usize));
        let [Some(a), Some(b), Some(c)] = vertices else {
            return None;
        };
        if area(mesh, piece.triangles[member]) <= 0.0 {
            continue;
        }
        let place =
            |vertex: &uvunwrap::OutputVertex| [f64::from(vertex.uv[0]) * page[0], -f64::from(vertex.uv[1]) * page[1]];
        let Some(chart) = a.chart else { continue };
        let corners = [a, b, c].map(place);
        // Too thin for the solver: it shrank to a point or a line.
        if flat_area(corners) <= 0.0 {
            continue;
        }
        let entry = by_chart.entry(chart).or_default();
        entry.0.push(member as u32);
        entry.1.push(corners);
    }
    Some(by_chart.into_values().collect())
}

/// Returns every triangle as a chart in its own plane, for a piece that the solver cannot flatten.
fn one_by_one(mesh: &Mesh, triangles: &[u32]) -> Vec<LocalChart> {
    let with_area = (0..triangles.len() as u32).filter(|&member| area(mesh, triangles[member as usize]) > 0.0);
    with_area
        .map(|member| {
            let corners = mesh.triangles[triangles[member as usize] as usize];
            let [a, b, c] = corners.map(|vertex| glam::DVec3::from(mesh.positions[vertex as usize].map(f64::from)));
            let (ab, ac) = (b - a, c - a);
            let along = ab / ab.length();
            let height = (ac - along * ac.dot(along)).length();
            // Counter-clockwise as seen is upward, against v.
            let flat = [[0.0, 0.0], [ab.length(), 0.0], [ac.dot(along), -height]];
            (vec![member], vec![flat])
        })
        .collect()
}
