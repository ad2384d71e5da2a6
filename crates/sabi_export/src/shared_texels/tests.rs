//! Shared texels of small atlases.

use crate::layout::tests::atlas;
use crate::{SetLayout, layouts};

use super::*;

fn shared(atlas: &Atlas, is_merged: bool) -> Vec<(Vec<u32>, Vec<u32>)> {
    let mut shared = SharedTexels::default();
    for mut layout in layouts(atlas) {
        if is_merged {
            layout = SetLayout::merged(atlas, layout.key);
        }
        shared.add(atlas, &layout);
    }
    let groups = shared.groups();
    groups.map(|[from, to]| (from.to_vec(), to.to_vec())).collect()
}

/// The group that a texel is a target of.
fn of(groups: &[(Vec<u32>, Vec<u32>)], texel: u32) -> Option<&(Vec<u32>, Vec<u32>)> {
    let mut found = groups.iter().filter(|(_, targets)| targets.contains(&texel));
    let first = found.next();
    assert!(found.next().is_none(), "{texel} is in several groups");
    first
}

#[test]
fn charts_that_lie_apart_share_nothing_even_where_their_rings_meet() {
    let atlas = atlas(
        16,
        32,
        &[(0, [0, 0], [0, 0], 2..5, 2..12), (0, [11, 0], [0, 0], 16..18, 2..12)],
    );
    assert_eq!(shared(&atlas, false), []);
    assert_eq!(shared(&atlas, true), []);
}

#[test]
fn a_chart_that_lost_its_place_shows_what_the_first_one_has_there_and_its_ring_too() {
    // Both at uv texels 4..8, the second one a column wider; a third one is beside them.
    let atlas = atlas(
        16,
        48,
        &[
            (0, [0, 0], [0, 0], 4..8, 4..8),
            (0, [16, 0], [0, 0], 20..25, 4..8),
            (0, [32, 0], [0, 0], 42..44, 4..8),
        ],
    );
    let groups = shared(&atlas, false);
    let row = 5 * 48;
    assert_eq!(of(&groups, row + 20), Some(&(vec![row + 4], vec![row + 20])), "owned");
    assert_eq!(of(&groups, row + 24), None, "a pixel that it has for itself");
    assert_eq!(
        of(&groups, row + 19),
        Some(&(vec![row + 3], vec![row + 19])),
        "a ring under another ring"
    );
    assert!(
        groups
            .iter()
            .all(|(sources, targets)| sources.len() == 1 && targets.len() == 1)
    );
    let of_third = |x: u32| groups.iter().any(|(_, targets)| targets.contains(&(row + x)));
    assert!(
        !(0..9).any(of_third) && !(41..46).any(of_third),
        "what lost nothing stays"
    );
}

#[test]
fn merged_charts_all_show_the_mean() {
    let atlas = atlas(
        16,
        32,
        &[(0, [0, 0], [0, 0], 4..8, 4..8), (0, [16, 0], [0, 0], 20..24, 4..8)],
    );
    let groups = shared(&atlas, true);
    let row = 5 * 32;
    let both = |x: u32| vec![row + x, row + x + 16];
    assert_eq!(of(&groups, row + 4), Some(&(both(4), both(4))), "owned");
    assert_eq!(of(&groups, row + 3), Some(&(both(3), both(3))), "the rings");
    assert_eq!(groups.len(), 36);
}

#[test]
fn beyond_the_border_of_a_tile_the_ring_of_the_first_chart_stands_in() {
    // Both at uv texels 0..4, with room for a ring on all sides of their pages' places.
    let atlas = atlas(
        16,
        32,
        &[(0, [4, 4], [0, 0], 4..8, 4..8), (0, [20, 4], [0, 0], 20..24, 4..8)],
    );
    let groups = shared(&atlas, false);
    let row = 5 * 32;
    assert_eq!(of(&groups, row + 19), Some(&(vec![row + 3], vec![row + 19])), "beside");
    assert_eq!(
        of(&groups, 3 * 32 + 19),
        Some(&(vec![3 * 32 + 3], vec![3 * 32 + 19])),
        "a corner"
    );
}

#[test]
fn a_chart_larger_than_its_tile_shows_the_repeated_map() {
    let atlas = atlas(16, 48, &[(0, [4, 4], [0, 0], 4..24, 4..8)]);
    let groups = shared(&atlas, false);
    let row = 5 * 48;
    assert_eq!(
        of(&groups, row + 20),
        Some(&(vec![row + 4], vec![row + 20])),
        "once around"
    );
    assert_eq!(of(&groups, row + 19), None);
    assert_eq!(
        of(&groups, row + 24),
        Some(&(vec![row + 8], vec![row + 24])),
        "its ring is in the second tile, and no border of a tile is between"
    );
}
