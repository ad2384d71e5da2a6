//! Layouts of small atlases.

use sabi_surface::atlas::{AtlasReport, Chart, Ghost, TILE, TileRef};

use super::*;

/// A chart of the test atlas: material, offset, uv tile, and its texels on the page.
pub(crate) type ChartPiece = (u32, [i32; 2], [i32; 2], std::ops::Range<u32>, std::ops::Range<u32>);

/// An atlas of rectangles, each of one triangle's number, with rings of one ghost where there is room.
pub(crate) fn atlas(size: u32, page: u32, pieces: &[ChartPiece]) -> Atlas {
    let mut owners = vec![EMPTY; (page * page) as usize];
    let mut charts = Vec::new();
    let mut ghosts = Vec::new();
    for (index, (material, offset, uv_tile, columns, rows)) in pieces.iter().cloned().enumerate() {
        for y in rows.clone() {
            for x in columns.clone() {
                owners[(y * page + x) as usize] = index as u32;
            }
        }
        charts.push(Chart {
            uv_chart: index as u32,
            page: 0,
            texel_from_uv: offset,
            bounds: [columns.start, rows.start, columns.end, rows.end],
            material,
            sheet: material,
            uv_tile,
            mirrored: false,
            triangles: 1,
            texels: (columns.len() * rows.len()) as u32,
        });
    }
    for (index, (.., columns, rows)) in pieces.iter().enumerate() {
        for y in rows.start.saturating_sub(1)..(rows.end + 1).min(page) {
            for x in columns.start.saturating_sub(1)..(columns.end + 1).min(page) {
                let owner = &mut owners[(y * page + x) as usize];
                if *owner == EMPTY {
                    *owner = GHOST_BIT | ghosts.len() as u32;
                    ghosts.push(loose_ghost([x, y, 0], index as u32));
                }
            }
        }
    }
    let side = page / TILE;
    Atlas {
        size,
        page_size: [page; 2],
        pages: 1,
        owners,
        udim_sheets: charts.iter().map(|chart| chart.sheet).collect(),
        triangle_chart: (0..charts.len() as u32).collect(),
        triangle_texels: vec![[[0.0; 2]; 3]; charts.len()],
        charts,
        ghosts,
        tiles: (0..side * side)
            .map(|i| TileRef {
                page: 0,
                row: i / side,
                column: i % side,
            })
            .collect(),
        leap: vec![1; (page * page) as usize],
        report: AtlasReport::default(),
    }
}

fn key(material: u32, uv_tile: [i32; 2], udim: Option<u32>) -> SetKey {
    SetKey {
        material,
        uv_tile,
        udim,
    }
}

#[test]
fn a_texel_between_two_charts_goes_to_the_nearer_one() {
    // Two texels apart in the user's layout, further on the page: their rings of two share places on the map.
    let mut atlas = atlas(
        16,
        32,
        &[(0, [0, 0], [0, 0], 2..5, 2..12), (0, [8, 0], [0, 0], 15..18, 2..12)],
    );
    for y in 2..12 {
        for (x, chart) in [(6, 0), (13, 1)] {
            atlas.owners[32 * y + x] = GHOST_BIT | atlas.ghosts.len() as u32;
            atlas.ghosts.push(loose_ghost([x as u32, y as u32, 0], chart));
        }
    }
    let layout = &layouts(&atlas)[0];
    let sources = [5, 6].map(|x| layout.source[5 * 16 + x]);
    assert_eq!(sources, [5 * 32 + 5, 5 * 32 + 14], "the inner ring of each");
}

#[test]
fn a_chart_in_its_place_is_copied_texel_for_texel() {
    let atlas = atlas(16, 16, &[(0, [0, 0], [0, 0], 2..10, 3..9)]);
    assert_eq!(set_keys(&atlas), [key(0, [0, 0], None)]);
    let layout = &layouts(&atlas)[0];
    for (pixel, &source) in layout.source.iter().enumerate() {
        let expected = if atlas.owners[pixel] == EMPTY {
            NONE
        } else {
            pixel as u32
        };
        assert_eq!(source, expected);
    }
    assert_eq!(layout.cover.iter().filter(|&&cover| cover == Cover::Owned).count(), 48);
    assert_eq!(layout.cover.iter().filter(|&&cover| cover == Cover::Ghost).count(), 32);
}

#[test]
fn a_moved_chart_goes_back_to_its_place_and_loses_the_ring_outside() {
    // The chart's own place is 0..8 × 0..8; on the page it lies at 10..18.
    let atlas = atlas(16, 32, &[(0, [10, 10], [0, 0], 10..18, 10..18)]);
    let layout = &layouts(&atlas)[0];
    assert_eq!(layout.source[0], 10 * 32 + 10);
    assert_eq!(layout.cover[8], Cover::Ghost, "to the right");
    assert_eq!(
        layout.cover[15],
        Cover::Empty,
        "the ring on the left does not wrap around"
    );
    assert_eq!(layout.collisions, 0);
}

#[test]
fn the_lower_chart_wins_where_charts_overlap_and_owned_beats_ghost() {
    // Both at uv texels 0..4: the second is the same place, packed elsewhere, and reaches one texel further.
    let atlas = atlas(
        16,
        32,
        &[(0, [0, 0], [0, 0], 0..4, 0..4), (0, [20, 0], [0, 0], 20..25, 0..4)],
    );
    let layout = &layouts(&atlas)[0];
    assert_eq!(layout.source[0], 0);
    assert_eq!(
        layout.source[4], 24,
        "the second chart's own texel, not the first one's ghost"
    );
    assert_eq!(layout.cover[4], Cover::Owned);
    assert_eq!(layout.cover[5], Cover::Ghost);
    assert_eq!(layout.collisions, 16);
    let merged = SetLayout::merged(&atlas, layout.key);
    assert_eq!(
        merged.sources(0).collect::<Vec<_>>(),
        [0, 20],
        "all owners, and no ghost with them"
    );
    assert_eq!(merged.sources(4).collect::<Vec<_>>(), [24]);
    assert_eq!((&merged.source, layout.shared.len()), (&layout.source, 0));
}

#[test]
fn materials_have_sets_of_their_own() {
    let atlas = atlas(
        16,
        32,
        &[(0, [0, 0], [0, 0], 0..4, 0..4), (2, [20, 0], [0, 0], 20..24, 0..4)],
    );
    assert_eq!(set_keys(&atlas), [key(0, [0, 0], None), key(2, [0, 0], None)]);
    let layouts = layouts(&atlas);
    assert_eq!((layouts[0].source[0], layouts[1].source[0]), (0, 20));
}

#[test]
fn several_tiles_of_a_material_are_udims_and_spilled_texels_go_to_the_tile_they_fall_in() {
    // Second chart: tile (1, −1), that is 1012; its uv texels are 16..20 × −16..−12, and one column spills from tile 0.
    let first = (0, [0, 0], [0, 0], 8..17, 0..4);
    let second = (0, [4, 36], [1, -1], 20..24, 20..24);
    let third = (0, [-16, 0], [2, 0], 24..28, 4..8);
    let atlas = atlas(16, 32, &[first, second, third]);
    let keys = set_keys(&atlas);
    assert_eq!(
        keys.iter().map(|key| key.udim).collect::<Vec<_>>(),
        [Some(1001), Some(1003), Some(1012)]
    );
    let layouts = layouts(&atlas);
    assert_eq!(layouts[2].source[0], 20 * 32 + 20);
    // Tile (1, 0) has no set: the spilled column wraps in its own.
    assert_eq!(layouts[0].source[0], 16);
    assert_eq!(layouts[1].source[4 * 16 + 8], 4 * 32 + 24);
}

#[test]
fn tiles_without_a_udim_number_wrap_onto_one_set() {
    let atlas = atlas(
        16,
        64,
        &[(0, [0, 0], [0, 0], 0..4, 0..4), (0, [40, 0], [-1, 0], 28..32, 0..4)],
    );
    assert_eq!(set_keys(&atlas), [key(0, [-1, 0], None)]);
    let layout = &layouts(&atlas)[0];
    // uv texels −12..−8 wrap to 4..8.
    assert_eq!((layout.source[0], layout.source[4]), (0, 28));
    assert_eq!(udim_number([0, 1]), None);
    assert_eq!(udim_number([9, 0]), Some(1010));
    assert_eq!(udim_number([10, 0]), None);
}

/// A ghost that leads nowhere.
pub(crate) fn loose_ghost(texel: [u32; 3], chart: u32) -> Ghost {
    Ghost {
        texel,
        chart,
        target_triangle: 0,
        target_texel: [0.0; 2],
        target_from_own: [[1.0, 0.0], [0.0, 1.0]],
        read_triangle: 0,
        read_texel: [0.0; 2],
    }
}
