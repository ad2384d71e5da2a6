//! The points around each point: those whose cells touch its own, and the points around these.

use super::Lists;
use super::texels::TexelGraph;

/// For each point itself first, its neighbors and the neighbors of these, in the order of their numbers.
pub(super) fn around(graph: &TexelGraph, point_of_texel: &[u32], count: usize) -> Lists<u32> {
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (texel, point) in point_of_texel.iter().enumerate() {
        for near in graph.neighbors.of(texel) {
            let other = point_of_texel[*near as usize];
            if other != *point {
                beside[*point as usize].push(other);
            }
        }
    }
    for list in &mut beside {
        list.sort_unstable();
        list.dedup();
    }
    Lists::new((0..count).map(|point| {
        let near = &beside[point];
        let mut ring: Vec<u32> = near
            .iter()
            .flat_map(|other| &beside[*other as usize])
            .chain(near)
            .copied()
            .collect();
        ring.sort_unstable();
        ring.dedup();
        ring.retain(|other| *other as usize != point);
        ring.insert(0, point as u32);
        ring
    }))
}
