//! Displacement of vertices: all at one position move to one position.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::split::Split;

/// Least length of the mean normal, relative to its weights, at which it has a direction.
const LEAST_AGREEMENT: f64 = 1e-3;

/// Vertex of the finer mesh that shares a position with others.
struct Member {
    chart: u32,
    texel: [f32; 2],
    normal: DVec3,
    weight: f64,
}

/// The displaced positions of all vertices, in the order of the splits.
pub(super) fn lift(
    splits: &[Split],
    positions: &[[f32; 3]],
    chart_of: impl Fn(usize) -> u32 + Sync,
    height: impl Fn(u32, [f32; 2]) -> Option<f32> + Sync,
) -> Vec<[f32; 3]> {
    let starts: Vec<usize> = splits
        .iter()
        .scan(0, |sum, split| {
            let start = *sum;
            *sum += split.vertices.len();
            Some(start)
        })
        .collect();
    let member = |vertex: u32| {
        let split = starts.partition_point(|&start| start <= vertex as usize) - 1;
        let local = vertex as usize - starts[split];
        let at = &splits[split].vertices[local];
        Member {
            chart: chart_of(split),
            texel: at.texel,
            normal: Vec3::from(at.normal).as_dvec3().normalize_or_zero(),
            weight: splits[split].weight(local),
        }
    };
    let places = places(positions);
    let groups: Vec<&[(Key, u32)]> = places.chunk_by(|a, b| a.0 == b.0).collect();
    let lifted: Vec<[f32; 3]> = groups
        .par_iter()
        .map(|group| {
            let members: Vec<Member> = group.iter().map(|&(_, vertex)| member(vertex)).collect();
            let displacement = direction(&members) * mean_height(&members, &height);
            let from = Vec3::from(group[0].0.map(f32::from_bits));
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

/// Bits of a position.
type Key = [u32; 3];

/// All vertices with the bits of their positions, those of one place together and in rising order.
fn places(positions: &[[f32; 3]]) -> Vec<(Key, u32)> {
    let mut places: Vec<(Key, u32)> = positions
        .par_iter()
        .enumerate()
        // + 0.0 turns −0 into 0.
        .map(|(vertex, at)| (at.map(|value| (value + 0.0).to_bits()), vertex as u32))
        .collect();
    places.par_sort_unstable();
    places
}

/// Mean of the unit normals, weighted by angle as far as triangles meet at a corner; zero where they cancel each other out.
fn direction(members: &[Member]) -> DVec3 {
    let weights: f64 = members.iter().map(|member| member.weight).sum();
    let sum: DVec3 = members.iter().map(|member| member.normal * member.weight).sum();
    if sum.length() > LEAST_AGREEMENT * weights {
        sum.normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}

/// Returns the mean height of the charts that meet at a vertex. Each place of a chart counts once, however many triangles
/// meet there.
fn mean_height(members: &[Member], height: impl Fn(u32, [f32; 2]) -> Option<f32>) -> f64 {
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
