//! Borders of small artificial charts.

use super::*;
use crate::layout::tests::{atlas, loose_ghost};
use crate::{Padding, PaddingMap, set_keys};

/// Pixels along a side of the maps.
const SIZE: u32 = 32;

/// Creates two charts of one material with two rings of ghosts each: columns 4 to 12 and 20 to 28 of rows 4 to 28. Ghosts
/// show the other chart, or the border of their own.
fn two_charts(show_neighbors: bool) -> Atlas {
    let mut made = atlas(
        SIZE,
        SIZE,
        &[(0, [0, 0], [0, 0], 4..12, 4..28), (0, [0, 0], [0, 0], 20..28, 4..28)],
    );
    for (chart, columns) in [(0, 2..14_u32), (1, 18..30)] {
        for (x, y) in columns.flat_map(|x| (2..30_u32).map(move |y| (x, y))) {
            let owner = &mut made.owners[(y * SIZE + x) as usize];
            if *owner == EMPTY {
                *owner = GHOST_BIT | made.ghosts.len() as u32;
                made.ghosts.push(loose_ghost([x, y, 0], chart));
            }
        }
    }
    for ghost in &mut made.ghosts {
        ghost.target_triangle = if show_neighbors { 1 - ghost.chart } else { ghost.chart };
        ghost.target_texel = [0, 1].map(|axis| ghost.texel[axis] as f32 + 0.5);
    }
    made
}

/// Returns a map of the two charts whose texels, including ghosts, have the values of `value(column, row, chart,
/// is_owned)`: as gathered, and after borders repeat their charts.
fn maps<const N: usize>(
    channel: &Channel,
    value: impl Fn(u32, u32, u32, bool) -> [f32; N] + Sync,
) -> [ChannelPixels; 2] {
    maps_of(&two_charts(true), channel, value)
}

/// Returns the same maps for another atlas.
fn maps_of<const N: usize>(
    atlas: &Atlas,
    channel: &Channel,
    value: impl Fn(u32, u32, u32, bool) -> [f32; N] + Sync,
) -> [ChannelPixels; 2] {
    let layout = SetLayout::new(atlas, set_keys(atlas)[0]);
    let padding = PaddingMap::new(&layout, Padding::Infinite);
    let texel = |at: usize| {
        let (x, y) = (at as u32 % SIZE, at as u32 / SIZE);
        let owner = atlas.owners[at];
        let chart = u32::from(x >= SIZE / 2);
        let values = value(x, y, chart, owner & GHOST_BIT == 0);
        std::array::from_fn(|index| values.get(index).copied().unwrap_or(0.0))
    };
    let laid_out = padding.gather(&layout, channel, 0, texel);
    let mut settled = laid_out.clone();
    if ChartBorders::new(atlas, &layout).repeat_charts(channel, &mut settled) {
        padding.pad(channel, &mut settled);
    }
    [laid_out, settled]
}

/// Returns the next mip level, in which each texel is the mean of four.
fn halved(level: &[f32]) -> Vec<f32> {
    let side = level.len().isqrt();
    let mean = |at: usize| {
        let first = at / (side / 2) * 2 * side + at % (side / 2) * 2;
        (level[first] + level[first + 1] + level[first + side] + level[first + side + 1]) / 4.0
    };
    (0..level.len() / 4).map(mean).collect()
}

/// Reads a level with interpolation, at a position in pixels of the map.
fn read(level: &[f32], [x, y]: [f32; 2]) -> f32 {
    let side = level.len().isqrt() as i32;
    let [x, y] = [x, y].map(|at| at * side as f32 / SIZE as f32 - 0.5);
    let (left, top, u, v) = (x.floor() as i32, y.floor() as i32, x - x.floor(), y - y.floor());
    let texel = |x: i32, y: i32| level[(y.clamp(0, side - 1) * side + x.clamp(0, side - 1)) as usize];
    let row = |y| texel(left, y) * (1.0 - u) + texel(left + 1, y) * u;
    row(top) * (1.0 - v) + row(top + 1) * v
}

/// Returns different values for the two charts; a ghost has the value of the other chart.
fn of_side(chart: u32, is_owned: bool) -> f32 {
    f32::from(u8::from((chart == 0) == is_owned))
}

#[test]
fn what_is_read_in_a_chart_is_its_own_value_where_the_data_jumps_with_mips_to_the_third() {
    for channel in [Channel::Metallic, Channel::Mask("m".into()), Channel::Opacity] {
        let [laid_out, settled] = maps(&channel, |_, _, chart, is_owned| [of_side(chart, is_owned)]);
        assert!(read(&laid_out.data, [12.0, 16.0]) < 1.0, "the ghosts leak");
        let mut level = settled.data;
        for number in 0..4 {
            // The charts are eight texels apart, so from the second level on, a texel can cover the padding of both charts.
            let reach = if number < 2 {
                [4.0, 12.0, 20.0, 28.0]
            } else {
                [4.0, 8.0, 24.0, 28.0]
            };
            for (x, expected) in reach.into_iter().zip([1.0, 1.0, 0.0, 0.0]) {
                for y in 8..=24 {
                    assert_eq!(
                        read(&level, [x, y as f32]),
                        expected,
                        "{channel:?}, level {number}, {x} {y}"
                    );
                }
            }
            level = halved(&level);
        }
    }
}

#[test]
fn padding_of_a_color_contains_nothing_of_the_neighbor() {
    let (red, blue) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    let color = |_, _, chart, is_owned| if of_side(chart, is_owned) == 1.0 { red } else { blue };
    let [_, settled] = maps(&Channel::BaseColor, color);
    for (pixel, color) in settled.data.chunks_exact(3).enumerate() {
        let is_left = (pixel as u32 % SIZE) < SIZE / 2;
        assert_eq!(color, if is_left { red } else { blue }, "pixel {pixel}");
    }
}

#[test]
fn a_jump_is_detected_if_the_variation_beside_it_is_smaller() {
    // A slope across the border, with some noise, and a jump of ten times that.
    let grain = |x: u32, y: u32| ((x * 7 + y * 3) % 5) as f32 * 0.001;
    let own = |x: u32, y: u32| 0.02 * x as f32 + grain(x, y);
    let value = |x: u32, y: u32, _, is_owned| [own(x, y) + if is_owned { 0.0 } else { 1.0 }];
    let [_, settled] = maps(&Channel::Roughness, value);
    for y in 8..24 {
        for x in 12..16 {
            assert_eq!(settled.data[(y * SIZE + x) as usize], own(11, y), "{x} {y}");
        }
    }
}

#[test]
fn a_jump_of_one_component_is_detected_despite_noise_in_another() {
    let grain = |x: u32, y: u32| 0.5 + 0.5 * ((x * 7 + y * 3) % 5) as f32 / 4.0;
    let color = |x, y, chart, is_owned| match of_side(chart, is_owned) == 1.0 {
        true => [grain(x, y), 0.0, 0.0],
        false => [0.0, 0.0, grain(x, y)],
    };
    let [_, settled] = maps(&Channel::BaseColor, color);
    for (pixel, [red, _, blue]) in settled.data.as_chunks::<3>().0.iter().enumerate() {
        let [own, other] = if (pixel as u32 % SIZE) < SIZE / 2 {
            [red, blue]
        } else {
            [blue, red]
        };
        assert!(*own >= 0.5 && *other == 0.0, "pixel {pixel}: {red} {blue}");
    }
}

#[test]
fn at_a_border_of_the_surface_nothing_counts_as_a_jump() {
    let kink = |_, _, _, is_owned| [f32::from(u8::from(is_owned))];
    let [laid_out, settled] = maps_of(&two_charts(false), &Channel::Roughness, kink);
    assert!(laid_out == settled);
}

#[test]
fn what_goes_on_over_a_seam_keeps_its_bits() {
    let smooth = |x: u32, y: u32, _, _| [0.3 + 0.2 * (x as f32 * 0.7).sin() * (y as f32 * 0.4).cos()];
    let grainy = |x: u32, y: u32, _, _| [((x * x * 31 + y * 57 + x * y * 7) % 17) as f32 / 16.0];
    for channel in [Channel::Roughness, Channel::Height] {
        let [laid_out, settled] = maps(&channel, smooth);
        assert!(laid_out == settled, "{channel:?}");
        let [laid_out, settled] = maps(&channel, grainy);
        assert!(laid_out == settled, "{channel:?}");
    }
}

#[test]
fn both_sides_of_a_step_in_height_meet_beside_the_chart_and_padding_is_its_own() {
    let [laid_out, settled] = maps(&Channel::Height, |_, _, chart, is_owned| [of_side(chart, is_owned)]);
    let row = |map: &ChannelPixels| map.data[(16 * SIZE + 10) as usize..(16 * SIZE + 16) as usize].to_vec();
    assert_eq!(row(&laid_out), [1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(row(&settled), [1.0, 1.0, 0.0, 1.0, 1.0, 1.0]);
}

#[test]
fn ids_are_always_repeated_from_their_own_chart() {
    // Bands of two ids in each chart, and a third id beyond its borders.
    let id = |_, y, _, is_owned| match (is_owned, y % 2) {
        (true, 0) => [0.25; 3],
        (true, _) => [0.5; 3],
        (false, _) => [0.75; 3],
    };
    for map in [MeshMap::Id, MeshMap::MaterialId] {
        let [_, settled] = maps(&Channel::Mesh(map), id);
        assert!(settled.data.iter().all(|value| *value != 0.75));
    }
}

#[test]
fn normals_beyond_a_hard_edge_are_those_of_the_chart() {
    let [own, beyond] = [[0.0, 0.0, 1.0], [0.8, 0.0, 0.6]];
    let [_, settled] = maps(
        &Channel::Normal,
        |_, _, _, is_owned| if is_owned { own } else { beyond },
    );
    assert!(settled.data.as_chunks::<3>().0.iter().all(|normal| *normal == own));
}
