//! Parts of a chart that are close to each other in UV but not on the surface are placed separately.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use super::shapes::*;
use crate::atlas::build_inputs::BuildInputs;
use crate::atlas::charts::partition;
use crate::atlas::fixed_point_uvs::Uvs;
use crate::atlas::gaps::Gaps;
use crate::atlas::mask::{Mask, texel_box};
use crate::atlas::topology::Topology;
use crate::atlas::{Atlas, AtlasOptions, Chart, Owner, UvChart};
use crate::model::Mesh;

const SIZE: u32 = 256;

/// Width of a tooth in texels.
const TOOTH: f64 = 8.0;
const LENGTH: f64 = 80.0;
const BACK: f64 = 12.0;
const ROW: f64 = 4.0;

/// Creates a comb: teeth in a row on a strip, forming one chart. In space every other tooth is bent down and the others are bent up.
pub(super) fn comb(teeth: u32, gap: f64, turn: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let columns = 2 * teeth;
    let rows = ((BACK + LENGTH) / ROW) as u32;
    let (sin, cos) = turn.sin_cos();
    for row in 0..=rows {
        for column in 0..columns {
            let tooth = column / 2;
            let x = f64::from(tooth) * (TOOTH + gap) + f64::from(column % 2) * TOOTH;
            let y = f64::from(row) * ROW;
            let bend = if tooth % 2 == 0 { 2.0 } else { -2.0 };
            mesh.positions
                .push([x, y, bend * (y - BACK).max(0.0)].map(|value| value as f32));
            let turned = [cos * x - sin * y, sin * x + cos * y];
            mesh.uvs
                .push(turned.map(|value| ((value + 100.0) / f64::from(SIZE)) as f32));
        }
    }
    for row in 0..rows {
        for column in 0..columns - 1 {
            let is_gap = column % 2 == 1;
            if is_gap && f64::from(row + 1) * ROW > BACK {
                continue;
            }
            let at = row * columns + column;
            triangle(&mut mesh, [at, at + 1, at + columns + 1]);
            triangle(&mut mesh, [at, at + columns + 1, at + columns]);
        }
    }
    mesh
}

/// Returns the largest distance, on the surface, between a texel of a tooth and the points read up to two texels away from
/// it. Texels near the strip, where teeth are close to each other, do not count.
fn farthest_read(mesh: &Mesh, atlas: &Atlas) -> (f64, usize) {
    let position = |triangle: u32, texel: [f64; 2]| {
        let chart = &atlas.charts[atlas.triangle_chart[triangle as usize] as usize];
        let offset = chart.texel_from_uv;
        Affine::new(mesh, atlas.size, offset, triangle).position(DVec2::from(texel))
    };
    let content = |x: u32, y: u32, page: u32| -> Option<DVec3> {
        match atlas.owner(x, y, page) {
            Owner::Empty => None,
            Owner::Triangle(triangle) => Some(position(triangle, [f64::from(x) + 0.5, f64::from(y) + 0.5])),
            Owner::Ghost(index) => {
                let ghost = &atlas.ghosts[index as usize];
                Some(position(ghost.read_triangle, ghost.read_texel.map(f64::from)))
            }
        }
    };
    let [width, height] = atlas.page_size;
    let (mut farthest, mut count) = (0.0_f64, 0);
    for page in 0..atlas.pages {
        for (x, y) in (2..width - 2).flat_map(|x| (2..height - 2).map(move |y| (x, y))) {
            let Owner::Triangle(_) = atlas.owner(x, y, page) else {
                continue;
            };
            let Some(own) = content(x, y, page) else { continue };
            if own.y < BACK + 16.0 {
                continue;
            }
            let near = (y - 2..=y + 2).flat_map(|y| (x - 2..=x + 2).map(move |x| (x, y)));
            let reads = near.filter_map(|(x, y)| content(x, y, page));
            count += 1;
            farthest = reads.map(|read| read.distance(own)).fold(farthest, f64::max);
        }
    }
    (farthest, count)
}

#[test]
fn no_texel_reads_across_a_narrow_gap_of_its_chart() {
    // Two texels in each direction on a slope of two.
    let straight = 40.0_f64.sqrt();
    for gap in [0.2, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0] {
        for turn in [0.0, 0.3, std::f64::consts::FRAC_PI_4] {
            let mesh = comb(3, gap, turn);
            let atlas = Atlas::build(&mesh, &AtlasOptions::new(SIZE)).unwrap();
            let (farthest, count) = farthest_read(&mesh, &atlas);
            assert!(count > 1000, "{count} texels");
            assert!(
                farthest < straight + 1.0,
                "gap {gap}, turned by {turn}: {farthest} texels away, {} charts",
                atlas.charts.len()
            );
        }
    }
}

#[test]
fn a_chart_is_divided_only_at_narrow_gaps() {
    // Teeth that have another tooth between them may stay in one part.
    for (teeth, gap, charts) in [
        (2, 12.0, 1..=1),
        (5, 6.0, 1..=1),
        (2, 2.0, 2..=2),
        (5, 2.0, 2..=5),
        (5, 4.0, 2..=5),
    ] {
        let atlas = Atlas::build(&comb(teeth, gap, 0.0), &AtlasOptions::new(SIZE)).unwrap();
        let count = atlas.charts.len();
        assert!(
            charts.contains(&count),
            "{teeth} teeth, {gap} texels apart: {count} charts"
        );
    }
    for mesh in [cube(4), ball(16), square(PatchFrame::straight([0.5, 0.5], 0.9), 8)] {
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(SIZE)).unwrap();
        let topology = Topology::new(&mesh);
        let uvs = Uvs::check(&mesh, SIZE).unwrap();
        let orientations: Vec<i8> = (0..mesh.triangles.len() as u32).map(|at| uvs.orientation(at)).collect();
        assert_eq!(atlas.charts.len(), partition(&mesh, &topology, &orientations).len());
    }
}

#[test]
fn all_gaps_are_separated_even_if_there_are_too_many_to_find_good_cuts() {
    let mesh = comb(12, 2.0, 0.0);
    let topology = Topology::new(&mesh);
    let uvs = Uvs::check(&mesh, SIZE).unwrap();
    let plan = BuildInputs {
        mesh: &mesh,
        topology: &topology,
        uvs,
        orientations: &vec![1; mesh.triangles.len()],
        size: SIZE,
        page_limit: 2048,
        memory_bytes: u64::MAX,
    };
    let partition = partition(&mesh, &topology, plan.orientations);
    let gaps = Gaps {
        plan: &plan,
        partition: &partition,
    };
    let (mask, _) = Mask::of_chart(&uvs, partition.triangles(0), texel_box(&uvs, partition.triangles(0)));
    let sides = gaps.sides(0, &mask);
    assert!(sides.len() > 11 * 10, "{} sides", sides.len());
    let parts_with = |effort: usize| {
        let labels = gaps.parts(0, &sides, effort);
        for [a, b] in &sides {
            assert_ne!(labels[*a as usize], labels[*b as usize], "effort {effort}");
        }
        let mut parts = labels;
        parts.sort_unstable();
        parts.dedup();
        parts.len()
    };
    assert!((2..=12).contains(&parts_with(usize::MAX)));
    assert!(parts_with(0) > 12);
}

#[test]
fn parts_are_of_the_chart_in_uv_whatever_the_size() {
    let mesh = comb(5, 2.0, 0.3);
    for size in [128, SIZE, 1024] {
        let atlas = Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap();
        assert_eq!(atlas.charts.len() > 1, size <= SIZE, "{size}");
        assert_eq!(atlas.uv_charts().len(), 1, "{size}");
        assert!((0..mesh.triangles.len()).all(|triangle| atlas.uv_chart(triangle) == 0));
        assert!(atlas.charts.iter().all(|chart| chart.uv_tile == [0, 0]));
        let level = atlas.level(&mesh, 1).unwrap();
        assert_eq!(level.atlas.uv_charts().len(), 1, "{size}");
    }
}

#[test]
fn copies_are_divided_alike_whatever_the_order_of_their_triangles() {
    let one = comb(5, 2.0, 0.3);
    let mut both = one.clone();
    let first = one.positions.len() as u32;
    both.positions
        .extend(one.positions.iter().map(|[x, y, z]| [x + 500.0, *y, *z]));
    both.uvs.extend(&one.uvs);
    for corners in one.triangles.iter().rev() {
        triangle(&mut both, corners.map(|corner| first + corner));
    }
    let atlas = Atlas::build(&both, &AtlasOptions::new(SIZE)).unwrap();
    assert_eq!(atlas.uv_charts().len(), 2);
    assert_eq!(atlas.report.stacked_charts, 1);
    let parts = |of: &UvChart| -> BTreeSet<([i64; 4], u32)> {
        let in_uv = |part: &&Chart| {
            let corner = |at: usize| i64::from(part.bounds[at]) - i64::from(part.texel_from_uv[at % 2]);
            ([0, 1, 2, 3].map(corner), part.texels)
        };
        of.parts.iter().map(in_uv).collect()
    };
    let [one, copy] = &atlas.uv_charts()[..] else {
        panic!("two charts")
    };
    assert!(one.parts.len() > 1);
    assert_eq!(parts(one), parts(copy));
    assert_eq!(one.extent(), copy.extent());
}

#[test]
fn a_chart_whose_parts_would_be_too_large_stays_whole_with_a_warning() {
    // Teeth of two texels, half a texel apart. Each takes six texels including its rings.
    let size = 64;
    for (teeth, is_whole) in [(20, false), (700, true)] {
        let atlas = Atlas::build(&comb(teeth, 2.0, 0.0), &AtlasOptions::new(size)).unwrap();
        let warnings = &atlas.report.warnings;
        let is_told = warnings.iter().any(|warning| warning.contains("close to each other"));
        assert_eq!(is_told, is_whole, "{teeth} teeth: {warnings:?}");
        assert_eq!(atlas.charts.len() == 1, is_whole, "{teeth} teeth");
    }
}
