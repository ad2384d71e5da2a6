//! Rings of charts never touch, and charts keep their place if possible.

use super::gaps::comb;
use super::shapes::*;
use crate::atlas::{Atlas, AtlasError, AtlasOptions, EMPTY, GHOST_BIT, Owner, RINGS, TILE};
use crate::model::Mesh;

/// Creates charts of random size, rotation and place, which may cover each other.
fn scattered(seed: u32, charts: u32) -> Mesh {
    let mut dice = PcgRandom(seed);
    let mut mesh = Mesh::default();
    for number in 0..charts {
        let frame = PatchFrame {
            center: [dice.between(-0.5, 1.5), dice.between(-0.5, 1.5)],
            scale: dice.between(0.005, 0.3),
            turn: dice.between(0.0, 6.3),
            mirrored: dice.next() & 1 == 1,
        };
        let place = [f64::from(number) * 2.0, 0.0, 0.0];
        patch(
            &mut mesh,
            [place, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            frame,
            1 + dice.next() % 3,
        );
    }
    mesh
}

/// Asserts that every texel within the rings around owned texels of a chart is owned by that chart or is its ghost.
fn assert_rings_are_whole(atlas: &Atlas) {
    let [width, height] = atlas.page_size.map(i64::from);
    let ring = i64::from(RINGS);
    let chart_of = |owner: Owner| match owner {
        Owner::Empty => None,
        Owner::Triangle(triangle) => Some(atlas.triangle_chart[triangle as usize]),
        Owner::Ghost(ghost) => Some(atlas.ghosts[ghost as usize].chart),
    };
    let mut ringed = vec![false; atlas.ghosts.len()];
    for page in 0..atlas.pages {
        for y in 0..height {
            for x in 0..width {
                let here = atlas.owner(x as u32, y as u32, page);
                let Owner::Triangle(_) = here else { continue };
                for (dx, dy) in (-ring..=ring).flat_map(|dy| (-ring..=ring).map(move |dx| (dx, dy))) {
                    let (near_x, near_y) = (x + dx, y + dy);
                    assert!(
                        near_x >= 0 && near_y >= 0 && near_x < width && near_y < height,
                        "a ring leaves the page"
                    );
                    let near = atlas.owner(near_x as u32, near_y as u32, page);
                    assert_eq!(chart_of(near), chart_of(here), "at {x} {y} on page {page}");
                    if let Owner::Ghost(ghost) = near {
                        ringed[ghost as usize] = true;
                    }
                }
            }
        }
    }
    assert!(ringed.iter().all(|&ringed| ringed), "a ghost without a chart");
}

fn assert_whole(atlas: &Atlas, mesh: &Mesh) {
    assert_rings_are_whole(atlas);
    let texels = atlas.owners.len();
    assert_eq!(texels as u32, atlas.page_size[0] * atlas.page_size[1] * atlas.pages);
    assert_eq!(atlas.leap.len(), texels);
    assert_eq!(atlas.page_size.map(|side| side % TILE), [0, 0]);
    for (texel, &owner) in atlas.owners.iter().enumerate() {
        match owner {
            EMPTY => assert_eq!(atlas.leap[texel], 0),
            owner if owner & GHOST_BIT != 0 => assert!(((owner & !GHOST_BIT) as usize) < atlas.ghosts.len()),
            owner => assert!((owner as usize) < mesh.triangles.len()),
        }
    }
    let used: std::collections::BTreeSet<_> = (0..texels)
        .filter(|&texel| atlas.owners[texel] != EMPTY)
        .map(|texel| {
            let (row, x) = (texel as u32 / atlas.page_size[0], texel as u32 % atlas.page_size[0]);
            (row / atlas.page_size[1], row % atlas.page_size[1] / TILE, x / TILE)
        })
        .collect();
    assert!(
        atlas
            .tiles
            .iter()
            .map(|tile| (tile.page, tile.row, tile.column))
            .eq(used)
    );
    for ghost in &atlas.ghosts {
        let numbers = ghost.target_texel.iter().chain(ghost.target_from_own.iter().flatten());
        assert!(numbers.into_iter().all(|value| value.is_finite()), "{ghost:?}");
    }
}

#[test]
fn rings_are_whole_and_never_meet_in_any_layout() {
    for seed in 0..12 {
        let mesh = scattered(seed, 3 + seed * 4);
        for size in [16, 50, 128, 300] {
            let atlas = Atlas::build(&mesh, &AtlasOptions::new(size)).unwrap();
            assert_whole(&atlas, &mesh);
        }
    }
}

#[test]
fn charts_spread_over_pages_when_one_is_full() {
    let mesh = scattered(5, 30);
    let atlas = Atlas::build(
        &mesh,
        &AtlasOptions {
            page_limit: 128,
            ..AtlasOptions::new(256)
        },
    )
    .unwrap();
    assert!(atlas.pages > 1);
    assert!(atlas.page_size.iter().all(|&side| side <= 128));
    assert_whole(&atlas, &mesh);
}

#[test]
fn a_valid_layout_keeps_its_place() {
    let mesh = cube(2);
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap();
    assert_eq!(atlas.page_size, [256, 256]);
    assert_eq!(atlas.report.moved_charts, 0);
    assert!(atlas.charts.iter().all(|chart| chart.texel_from_uv == [0, 0]));
}

#[test]
fn a_layout_that_touches_the_border_is_moved_as_a_whole() {
    let mesh = square(PatchFrame::straight([0.5, 0.5], 1.0), 2);
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(64)).unwrap();
    assert_eq!(atlas.page_size, [80, 80]);
    assert_eq!(atlas.charts[0].texel_from_uv, [8, 8]);
    assert_eq!(atlas.charts[0].bounds, [8, 8, 72, 72]);
    assert_eq!(atlas.report.moved_charts, 0);
    assert_eq!(atlas.report.coverage, 1.0);
    assert_whole(&atlas, &mesh);
}

#[test]
fn threads_and_runs_do_not_change_a_byte() {
    for mesh in [scattered(9, 20), comb(5, 2.0, 0.3)] {
        let build = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| Atlas::build(&mesh, &AtlasOptions::new(200)).unwrap())
        };
        let first = build(1);
        assert_eq!(first, build(2));
        assert_eq!(first, build(5));
        assert_eq!(first, build(1));
    }
}

#[test]
fn a_chart_that_overlaps_itself_is_split() {
    // A screw: three turns over the same ring of UV.
    let mut mesh = Mesh::default();
    let steps = 48;
    for step in 0..=steps {
        let angle = f64::from(step) / f64::from(steps) * 3.0 * std::f64::consts::TAU;
        for (side, radius) in [(0, 0.2), (1, 0.45)] {
            mesh.positions
                .push([radius * angle.cos(), angle / 10.0, radius * angle.sin()].map(|value| value as f32));
            mesh.uvs
                .push([0.5 + radius * angle.cos(), 0.5 + radius * angle.sin()].map(|value| value as f32));
            let at = 2 * step + side;
            if step > 0 {
                triangle(
                    &mut mesh,
                    if side == 0 {
                        [at - 2, at - 1, at]
                    } else {
                        [at - 2, at, at - 1]
                    },
                );
            }
        }
    }
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(128)).unwrap();
    // At least three. A full turn is divided again, since its end lies beside its start.
    assert!((3..=8).contains(&atlas.charts.len()), "{} charts", atlas.charts.len());
    assert_whole(&atlas, &mesh);
    assert_eq!(atlas.report.unlinked_ghosts, 0);
    // All texels of three turns, with no texel lost.
    let ring = std::f64::consts::PI * (0.45f64.powi(2) - 0.2f64.powi(2)) * 128.0 * 128.0;
    let owned: u32 = atlas.charts.iter().map(|chart| chart.texels).sum();
    assert!(
        (f64::from(owned) / (3.0 * ring) - 1.0).abs() < 0.05,
        "{owned} of {}",
        3.0 * ring
    );
}

#[test]
fn levels_have_the_same_charts_and_lead_to_the_same_uv() {
    let mesh = scattered(4, 12);
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(512)).unwrap();
    for number in 1..4 {
        let level = atlas.level(&mesh, number).unwrap();
        assert_eq!(level.atlas.size, 512 >> number);
        assert_eq!(level.atlas.triangle_chart, atlas.triangle_chart);
        assert_whole(&level.atlas, &mesh);
        for (triangle, &chart) in atlas.triangle_chart.iter().enumerate() {
            for corner in 0..3 {
                let fine = atlas.triangle_texels[triangle][corner].map(f64::from);
                let coarse = level.coarse_texel_from_fine(chart, fine);
                let expected = level.atlas.triangle_texels[triangle][corner].map(f64::from);
                assert!((coarse[0] - expected[0]).abs() < 1e-3 && (coarse[1] - expected[1]).abs() < 1e-3);
                let again = level.fine_texel_from_coarse(chart, coarse);
                assert!((again[0] - fine[0]).abs() < 1e-9 && (again[1] - fine[1]).abs() < 1e-9);
            }
        }
    }
    let error = atlas.level(&mesh, 7).unwrap_err();
    assert_eq!(
        error.to_string(),
        "level 7 of an atlas of 512 texels would be 4 texels, but it has to keep at least 8"
    );
    assert!(matches!(
        atlas.level(&mesh, 40),
        Err(AtlasError::LevelTooSmall { level_size: 0, .. })
    ));
}

#[test]
fn leaps_stay_inside_their_chart() {
    let mesh = cube(1);
    let atlas = Atlas::build(&mesh, &AtlasOptions::new(256)).unwrap();
    let [width, height] = atlas.page_size.map(i64::from);
    let owned = |x: i64, y: i64| {
        (0..width).contains(&x)
            && (0..height).contains(&y)
            && matches!(atlas.owner(x as u32, y as u32, 0), Owner::Triangle(_))
    };
    for y in 0..height {
        for x in 0..width {
            let leap = i64::from(atlas.leap[(y * width + x) as usize]);
            for (dx, dy) in (-leap..=leap).flat_map(|dy| (-leap..=leap).map(move |dx| (dx, dy))) {
                assert!(
                    leap == 0 || dx * dx + dy * dy > leap * leap || owned(x + dx, y + dy),
                    "{leap} at {x} {y}"
                );
            }
        }
    }
    // The middle of the first chart, 57 texels wide.
    assert!(atlas.leap.iter().any(|&leap| leap >= 26));
}
