//! Components cut into charts and flattened, by the crate `uvunwrap`.

use sabi_cancel::Cancel;
use std::collections::BTreeMap;

use glam::{DVec2, Vec3};
use rayon::prelude::*;

use super::area::{area, flat_area};
use super::components::Component;
use crate::model::Mesh;

/// Number of triangles above which the charts of a component are kept small, since the time to flatten a chart grows faster than its size.
const LARGE: usize = 12_000;
/// Approximate limit of triangles of a chart of a large component.
const CHART_TRIANGLES: f64 = 3_000.0;

/// Maximum number of pairs of triangles of a component that the solver may compare. It sorts triangles by their bounding
/// boxes into grid squares of about four triangles, and slivers fall into many squares.
const MOST_PAIRS: f64 = 4e9;

/// A flattened chart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FlatChart {
    pub(super) triangles: Vec<u32>,
    /// Corners in model units, counter-clockwise in the image, where u goes right and v goes down.
    pub(super) corners: Vec<[DVec2; 3]>,
}

/// All charts of a mesh.
pub(super) struct FlatCharts {
    pub(super) charts: Vec<FlatChart>,
    /// Number of components that were flattened; the others are copies of these.
    pub(super) distinct: u32,
    /// Sentences about components that could not be flattened as a whole.
    pub(super) warnings: Vec<String>,
}

/// Flattens all components; similar ones are flattened once. Triangles without area are on no chart.
pub(super) fn flatten(mesh: &Mesh, components: &[Component]) -> FlatCharts {
    let is_first = |&index: &usize| components[index].similar_to.0 == index;
    let firsts: Vec<usize> = (0..components.len()).filter(is_first).collect();
    let cancel = Cancel::current();
    let flattened: Vec<(Vec<LocalChart>, Option<String>)> = firsts
        .par_iter()
        .inspect(|_| cancel.look())
        .map(|&index| charts_of(mesh, &components[index]))
        .collect();
    let mut charts = Vec::new();
    let mut failed: BTreeMap<&str, usize> = BTreeMap::new();
    for component in components {
        let (first, scale) = component.similar_to;
        let Ok(at) = firsts.binary_search(&first) else { continue };
        let (local, failure) = &flattened[at];
        if let Some(reason) = failure {
            *failed.entry(reason).or_default() += 1;
        }
        charts.extend(local.iter().map(|(members, corners)| {
            FlatChart {
                triangles: members
                    .iter()
                    .map(|&member| component.triangles[member as usize])
                    .collect(),
                corners: corners
                    .iter()
                    .map(|triangle| triangle.map(|corner| corner * scale))
                    .collect(),
            }
        }));
    }
    FlatCharts {
        charts,
        distinct: firsts.len() as u32,
        warnings: failed
            .iter()
            .map(|(reason, &count)| failure_warning(reason, count))
            .collect(),
    }
}

fn failure_warning(reason: &str, count: usize) -> String {
    let pieces = if count == 1 { "piece" } else { "pieces" };
    format!(
        "{count} {pieces} could not be laid flat as a whole, so each triangle there is a chart of its own: {reason}"
    )
}

/// Indices into a component's list of triangles, and their flattened corners.
type LocalChart = (Vec<u32>, Vec<[DVec2; 3]>);

/// Returns the charts of a component, and the solver's error if each triangle had to become a separate chart.
fn charts_of(mesh: &Mesh, component: &Component) -> (Vec<LocalChart>, Option<String>) {
    // A single triangle needs no solver. A model with a million loose triangles would otherwise need a million calls.
    if let [triangle] = component.triangles[..] {
        return (triangle_charts(mesh, &[triangle]), None);
    }
    match unwrapped(mesh, component) {
        Ok(charts) => (charts, None),
        Err(reason) => (triangle_charts(mesh, &component.triangles), Some(reason)),
    }
}

fn unwrapped(mesh: &Mesh, component: &Component) -> Result<Vec<LocalChart>, String> {
    let positions: Vec<[f32; 3]> = component
        .vertices
        .iter()
        .map(|&vertex| mesh.positions[vertex as usize])
        .collect();
    let (low, high) = positions.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), at| {
        (low.min(Vec3::from(*at)), high.max(Vec3::from(*at)))
    });
    let longest = (high.as_dvec3() - low.as_dvec3()).max_element();
    // Relative to the longest side, so that the solver's input does not depend on the size of the model.
    let scale = 1.0 / longest;
    let total: f64 = component.triangles.iter().map(|&triangle| area(mesh, triangle)).sum();
    let count = component.triangles.len();
    if pairs(mesh, component, total) > MOST_PAIRS {
        return Err("it is made of slivers, which take too long to compare".to_owned());
    }
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
        ..uvunwrap::MeshInput::new(&positions, &component.corners)
    };
    let found = uvunwrap::generate(&[input], &options).map_err(|error| error.to_string())?;
    let unit = 1.0 / (f64::from(TEXELS) * f64::from(scale as f32));
    let page = DVec2::new(f64::from(found.width), -f64::from(found.height)) * unit;
    let whole = found
        .meshes
        .first()
        .and_then(|found| charts(mesh, component, found, page));
    whole.ok_or_else(|| "the result has no place for some of its vertices".to_owned())
}

/// Estimates the number of pairs of triangles that the solver compares: those in the same grid square.
fn pairs(mesh: &Mesh, component: &Component, total_area: f64) -> f64 {
    let count = component.triangles.len() as f64;
    let square = 4.0 * total_area / count;
    let squares = |triangle: &u32| {
        let [a, b, c] = mesh.corners(*triangle);
        let longest = (b - a)
            .length_squared()
            .max((c - b).length_squared())
            .max((a - c).length_squared());
        // A sliver in any direction covers half of the square over its longest edge, a regular triangle about one grid square.
        (0.5 * longest / square).max(1.0)
    };
    let filled: f64 = component.triangles.iter().map(squares).sum();
    let in_each = filled / (count / 4.0).max(1.0);
    0.5 * filled * in_each
}

/// Resolution at which the crate returns its charts, in texels for the longest side of a component. Coordinates are not rounded to it.
const TEXELS: f32 = 512.0;

/// Sorts the crate's result by chart; `None` if a vertex is missing. The triangles have a positive area in (u, v), which is
/// clockwise in the image.
fn charts(mesh: &Mesh, component: &Component, found: &uvunwrap::OutputMesh, page: DVec2) -> Option<Vec<LocalChart>> {
    let mut by_chart: BTreeMap<u32, LocalChart> = BTreeMap::new();
    for (member, corners) in found.indices.as_chunks::<3>().0.iter().enumerate() {
        let vertices = corners.map(|corner| found.vertices.get(corner as usize));
        let [Some(a), Some(b), Some(c)] = vertices else {
            return None;
        };
        if area(mesh, component.triangles[member]) <= 0.0 {
            continue;
        }
        let place =
            |vertex: &uvunwrap::OutputVertex| DVec2::new(f64::from(vertex.uv[0]), f64::from(vertex.uv[1])) * page;
        let Some(chart) = a.chart else { continue };
        let corners = [a, b, c].map(place);
        // The solver shrinks very thin triangles to a point or a line.
        if flat_area(corners) <= 0.0 {
            continue;
        }
        let entry = by_chart.entry(chart).or_default();
        entry.0.push(member as u32);
        entry.1.push(corners);
    }
    Some(by_chart.into_values().collect())
}

/// Returns every triangle as a separate chart in its own plane, for a component that the solver cannot flatten.
fn triangle_charts(mesh: &Mesh, triangles: &[u32]) -> Vec<LocalChart> {
    let with_area = (0..triangles.len() as u32).filter(|&member| area(mesh, triangles[member as usize]) > 0.0);
    with_area
        .map(|member| {
            let [a, b, c] = mesh.corners(triangles[member as usize]);
            let (ab, ac) = (b - a, c - a);
            let along = ab / ab.length();
            let height = (ac - along * ac.dot(along)).length();
            // The third corner is above the first edge in a picture, where v grows downward.
            let flat = [
                DVec2::ZERO,
                DVec2::new(ab.length(), 0.0),
                DVec2::new(ac.dot(along), -height),
            ];
            (vec![member], vec![flat])
        })
        .collect()
}
