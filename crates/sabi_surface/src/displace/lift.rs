//! Displacement of vertices: all at one position move to one position.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::carve::{lateral, meeting};
use super::edges::HardEdges;
use super::rounded_normals::NormalRounding;
use super::subdivision::SplitTriangle;
use crate::model::Mesh;

/// Minimum length of the mean normal, relative to its weights, at which its direction is meaningful.
const LEAST_AGREEMENT: f64 = 1e-3;

/// Distance from a hard edge over which normals are rounded, as a multiple of the largest height.
const REACH: f64 = 2.0;
/// Maximum reach of rounding, as a share of the largest coordinate of the mesh.
const MOST_REACH: f64 = 0.5;

/// Vertex of the finer mesh that shares a position with others.
struct SharedVertex<'s> {
    split: &'s SplitTriangle,
    chart: u32,
    texel: [f32; 2],
    normal: DVec3,
    weight: f64,
}

/// The displaced positions of all vertices, in the order of the splits.
pub(super) fn lift(
    mesh: &Mesh,
    splits: &[SplitTriangle],
    positions: &[[f32; 3]],
    chart_of: impl Fn(usize) -> u32 + Sync,
    height: impl Fn(u32, [f32; 2]) -> Option<f32> + Sync,
) -> Vec<[f32; 3]> {
    let starts = starts(splits);
    let member = |vertex: u32| {
        let split = starts.partition_point(|&start| start <= vertex as usize) - 1;
        let local = vertex as usize - starts[split];
        let at = &splits[split].vertices[local];
        SharedVertex {
            split: &splits[split],
            chart: chart_of(split),
            texel: at.texel,
            normal: Vec3::from(at.normal).as_dvec3().normalize_or_zero(),
            weight: splits[split].weight(local),
        }
    };
    let places = places(positions);
    let groups: Vec<&[(PositionBits, u32)]> = places.chunk_by(|a, b| a.0 == b.0).collect();
    let members = |group: &[(PositionBits, u32)]| -> Vec<SharedVertex<'_>> {
        group.iter().map(|&(_, vertex)| member(vertex)).collect()
    };
    let heights: Vec<f64> = groups
        .par_iter()
        .map(|group| mean_height(&members(group), &height))
        .collect();
    let limit = heights.iter().fold(0.0, |limit: f64, height| limit.max(height.abs()));
    if limit == 0.0 {
        return positions.to_vec();
    }
    let reach = (limit * REACH).min(largest_coordinate(positions) * MOST_REACH);
    let edges = HardEdges::find(mesh, reach);
    let rounding = NormalRounding::new(&edges, reach);
    let lifted: Vec<[f32; 3]> = groups
        .par_iter()
        .zip(&heights)
        .map(|(group, &mean_height)| {
            let from = Vec3::from(group[0].0.map(f32::from_bits));
            if mean_height == 0.0 {
                return from.to_array();
            }
            let members = members(group);
            let displacement = displacement(&members, from.as_dvec3(), mean_height, limit, &rounding, &height);
            let to = (from.as_dvec3() + displacement).as_vec3();
            if to.is_finite() { to } else { from }.to_array()
        })
        .collect();
    let mut placed = vec![[0.0; 3]; positions.len()];
    for (group, at) in groups.iter().zip(lifted) {
        for &(_, vertex) in *group {
            placed[vertex as usize] = at;
        }
    }
    placed
}

/// Number of the first vertex of each split.
fn starts(splits: &[SplitTriangle]) -> Vec<usize> {
    let start = |sum: &mut usize, split: &SplitTriangle| {
        let start = *sum;
        *sum += split.vertices.len();
        Some(start)
    };
    splits.iter().scan(0, start).collect()
}

/// Returns the displacement of the vertices at a place, given their mean height and the largest height of all.
fn displacement(
    members: &[SharedVertex<'_>],
    place: DVec3,
    mean_height: f64,
    limit: f64,
    rounding: &NormalRounding<'_>,
    height: impl Fn(u32, [f32; 2]) -> Option<f32>,
) -> DVec3 {
    let mean = direction(members);
    if mean == DVec3::ZERO {
        return mean;
    }
    let mut normals: Vec<DVec3> = Vec::new();
    for member in members.iter().filter(|member| member.weight > 0.0) {
        if !normals.contains(&member.normal) {
            normals.push(member.normal);
        }
    }
    let Some(rounded) = rounding.at(place, &normals, mean) else {
        return mean * mean_height;
    };
    let tracks = tracks(members, rounded);
    rounded * meeting(limit, |length| mean_along(&tracks, length, &height))
}

/// Track of a tilted line over the texels of a chart.
struct Track {
    chart: u32,
    texel: [f32; 2],
    /// Texels for a length of 1.
    step: [f64; 2],
}

/// Returns the tracks over the charts that meet at a place, one for each face.
fn tracks(members: &[SharedVertex<'_>], direction: DVec3) -> Vec<Track> {
    let mut members: Vec<&SharedVertex<'_>> = members.iter().collect();
    let key = |member: &SharedVertex<'_>| {
        let normal = member.normal.to_array().map(f64::to_bits);
        (member.chart, member.texel.map(f32::to_bits), normal)
    };
    // The sort is stable: of the triangles of a face, the first one is used.
    members.sort_by_key(|member| key(member));
    members.dedup_by_key(|member| key(member));
    let track = |member: &&SharedVertex<'_>| Track {
        chart: member.chart,
        texel: member.texel,
        step: member.split.texels_of(lateral(direction, member.normal)),
    };
    members.iter().map(track).collect()
}

/// Returns the mean height at a length along the tracks; `None` if all tracks have left their charts.
fn mean_along(tracks: &[Track], length: f64, height: impl Fn(u32, [f32; 2]) -> Option<f32>) -> Option<f64> {
    let (mut sum, mut known) = (0.0, 0u32);
    for track in tracks {
        let at = |axis: usize| (f64::from(track.texel[axis]) + track.step[axis] * length) as f32;
        if let Some(height) = height(track.chart, [at(0), at(1)]) {
            sum += if height.is_finite() { f64::from(height) } else { 0.0 };
            known += 1;
        }
    }
    (known > 0).then(|| sum / f64::from(known))
}

fn largest_coordinate(positions: &[[f32; 3]]) -> f64 {
    let values = positions.iter().flatten().filter(|value| value.is_finite());
    values.fold(0.0, |largest: f64, value| largest.max(f64::from(value.abs())))
}

/// Bits of a position.
type PositionBits = [u32; 3];

/// Returns all vertices with the bits of their positions. Vertices at the same place are adjacent and in ascending order.
fn places(positions: &[[f32; 3]]) -> Vec<(PositionBits, u32)> {
    let mut places: Vec<(PositionBits, u32)> = positions
        .par_iter()
        .enumerate()
        // Adding 0.0 converts −0 to 0.
        .map(|(vertex, at)| (at.map(|value| (value + 0.0).to_bits()), vertex as u32))
        .collect();
    places.par_sort_unstable();
    places
}

/// Returns the mean of the unit normals, weighted by the angles of the triangles that meet at a corner; zero if the normals
/// cancel each other out.
fn direction(members: &[SharedVertex<'_>]) -> DVec3 {
    let weights: f64 = members.iter().map(|member| member.weight).sum();
    let sum: DVec3 = members.iter().map(|member| member.normal * member.weight).sum();
    if sum.length() > LEAST_AGREEMENT * weights {
        sum.normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}

/// Returns the mean height of the charts that meet at a vertex. Each place of a chart counts once, however many triangles meet there.
fn mean_height(members: &[SharedVertex<'_>], height: impl Fn(u32, [f32; 2]) -> Option<f32>) -> f64 {
    let mut samples: Vec<(u32, [u32; 2])> = members
        .iter()
        .map(|member| (member.chart, member.texel.map(f32::to_bits)))
        .collect();
    samples.sort_unstable();
    samples.dedup();
    let (mut sum, mut known) = (0.0, 0u32);
    for (chart, texel) in samples {
        if let Some(height) = height(chart, texel.map(f32::from_bits)) {
            sum += if height.is_finite() { f64::from(height) } else { 0.0 };
            known += 1;
        }
    }
    sum / f64::from(known.max(1))
}
