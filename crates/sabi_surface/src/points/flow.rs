//! Flow between points: the Voronoi cell of each point in its tangent plane, among the points around it.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::dart_throwing::Cells;
use super::texels::TexelGraph;
use super::{Flow, Lists};

/// Number of sides of the polygon around the texels of a cell. It bounds the cell at the border of an open surface.
const BOUND_SIDES: u32 = 16;
/// Radius that no cell exceeds, in spacings.
const WIDEST: f64 = 1.6;
/// Minimum area of a cell as a share of the flows to it, so that time steps are stable.
const LEAST_AREA: f64 = 0.25;

/// A corner of a cell, and the point beyond the side that starts there.
#[derive(Clone, Copy)]
struct CellCorner {
    place: DVec2,
    beyond: Option<u32>,
}

/// Flows to each point.
pub(super) fn flows(
    graph: &TexelGraph,
    cells: &Cells,
    members: &Lists<u32>,
    around: &Lists<u32>,
    spacing: f64,
) -> Lists<Flow> {
    let sides: Vec<Vec<(u32, f64)>> = (0..cells.centers.len())
        .into_par_iter()
        .map(|point| conductances(graph, cells, [members.of(point), around.of(point)], spacing))
        .collect();
    let scales = scales(cells, &sides);
    // The flow must be the same in both directions: use the mean of both estimates.
    let mut both: Vec<Vec<(u32, f64)>> = vec![Vec::new(); sides.len()];
    for (point, sides) in sides.iter().enumerate() {
        for (other, conductance) in sides {
            let half = 0.5 * conductance * scales[point];
            both[point].push((*other, half));
            both[*other as usize].push((point as u32, half));
        }
    }
    Lists::new(both.into_iter().enumerate().map(|(point, mut sides)| {
        sides.sort_by_key(|(other, _)| *other);
        let total: f64 = sides.iter().map(|(_, conductance)| conductance).sum();
        let area = (cells.sizes[point] / (spacing * spacing)).max(LEAST_AREA * total);
        let mut flows: Vec<Flow> = Vec::new();
        for (to, conductance) in sides {
            let rate = (conductance / area) as f32;
            match flows.last_mut() {
                Some(last) if last.to == to => last.rate += rate,
                _ => flows.push(Flow { to, rate }),
            }
        }
        flows
    }))
}

/// Returns a factor for the flows to each point, chosen so that coordinates in space flow correctly: the squared slope of a
/// coordinate along the surface, summed over the three coordinates, is 2 everywhere, and the cell has a quarter of it times
/// the area from each side. Cells in the tangent plane alone are too large where the surface is curved.
fn scales(cells: &Cells, sides: &[Vec<(u32, f64)>]) -> Vec<f64> {
    let of_point = |(point, sides): (usize, &Vec<(u32, f64)>)| {
        let slopes = sides.iter().map(|(other, conductance)| {
            conductance * cells.centers[point].distance_squared(cells.centers[*other as usize])
        });
        let found = slopes.sum::<f64>();
        let wanted = 4.0 * cells.sizes[point];
        if found > 0.0 {
            (wanted / found).clamp(0.5, 2.0)
        } else {
            1.0
        }
    };
    sides.iter().enumerate().map(of_point).collect()
}

/// Returns for each point whose cell shares a side with the cell of the first of `around` the length of that side divided by the distance.
fn conductances(graph: &TexelGraph, cells: &Cells, [members, around]: [&[u32]; 2], spacing: f64) -> Vec<(u32, f64)> {
    let Some((point, others)) = around.split_first() else {
        return Vec::new();
    };
    let center = cells.centers[*point as usize];
    let up = cells.areas[*point as usize].normalize_or(DVec3::Y);
    let (right, ahead) = up.any_orthonormal_pair();
    // Unrolled: the distance in the plane is that in space.
    let flat = |place: DVec3| {
        let away = place - center;
        DVec2::new(away.dot(right), away.dot(ahead)).normalize_or_zero() * away.length()
    };
    let mut near: Vec<(u32, DVec2)> = others
        .iter()
        .map(|other| (*other, flat(cells.centers[*other as usize])))
        .filter(|(_, place)| place.length_squared() > 0.0)
        .collect();
    near.sort_by(|a, b| {
        a.1.length_squared()
            .total_cmp(&b.1.length_squared())
            .then(a.0.cmp(&b.0))
    });
    let texels = members.iter().map(|texel| &graph.texels[*texel as usize]);
    let mut cell = if texels.clone().any(|texel| texel.is_at_border) {
        let texels = texels.map(|texel| (flat(texel.position), texel.area.length().sqrt()));
        bound(&texels.collect::<Vec<_>>())
    } else {
        bound(&[(DVec2::ZERO, WIDEST * spacing)])
    };
    for (other, place) in &near {
        cell = cut(&cell, *place, *other);
    }
    let sides = cell.iter().zip(cell.iter().cycle().skip(1));
    sides
        .filter_map(|(corner, next)| {
            let other = corner.beyond?;
            let (_, place) = near.iter().find(|(near, _)| *near == other)?;
            Some((other, corner.place.distance(next.place) / place.length()))
        })
        .collect()
}

/// Polygon around the texels of a cell, which are given by their places and widths.
fn bound(texels: &[(DVec2, f64)]) -> Vec<CellCorner> {
    let step = std::f64::consts::TAU / f64::from(BOUND_SIDES);
    let reach = |direction: DVec2| {
        let reach = texels.iter().map(|(place, width)| place.dot(direction) + width);
        reach.fold(0.0, f64::max)
    };
    let sides: Vec<(DVec2, f64)> = (0..BOUND_SIDES)
        .map(|side| DVec2::from_angle(f64::from(side) * step))
        .map(|direction| (direction, reach(direction)))
        .collect();
    let corners = sides.iter().zip(sides.iter().cycle().skip(1));
    corners
        .map(|((direction, reach), (_, next))| {
            // The corner at which the two sides meet.
            let along = (next - reach * step.cos()) / step.sin();
            CellCorner {
                place: *direction * *reach + direction.perp() * along,
                beyond: None,
            }
        })
        .collect()
}

/// Cuts off the part of a convex cell that is nearer to another point than to the origin.
fn cut(cell: &[CellCorner], other: DVec2, number: u32) -> Vec<CellCorner> {
    let beyond = |corner: &CellCorner| corner.place.dot(other) - 0.5 * other.length_squared();
    let mut kept = Vec::with_capacity(cell.len() + 1);
    for (corner, next) in cell.iter().zip(cell.iter().cycle().skip(1)) {
        let [from, to] = [beyond(corner), beyond(next)];
        let crossing = || corner.place.lerp(next.place, from / (from - to));
        if from <= 0.0 {
            kept.push(*corner);
            if to > 0.0 {
                kept.push(CellCorner {
                    place: crossing(),
                    beyond: Some(number),
                });
            }
        } else if to <= 0.0 {
            kept.push(CellCorner {
                place: crossing(),
                beyond: corner.beyond,
            });
        }
    }
    kept
}
