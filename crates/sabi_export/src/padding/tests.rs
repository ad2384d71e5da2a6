//! Padding of small and of made layouts.

use proptest::prelude::*;

use super::*;
use crate::SetKey;

fn layout(size: u32, covered: &[bool]) -> SetLayout {
    let cover = |&owned: &bool| if owned { Cover::Owned } else { Cover::Empty };
    let source = |(index, &owned): (usize, &bool)| if owned { index as u32 } else { NONE };
    SetLayout {
        key: SetKey {
            material: 0,
            uv_tile: [0, 0],
            udim: None,
        },
        size,
        source: covered.iter().enumerate().map(source).collect(),
        cover: covered.iter().map(cover).collect(),
        shared: Vec::new(),
        collisions: 0,
    }
}

fn at(map: &PaddingMap, pixel: usize) -> u32 {
    map.sources().nth(pixel).unwrap()
}

fn distance_squared(size: u32, a: u32, b: u32) -> i64 {
    let (ax, ay, bx, by) = (a % size, a / size, b % size, b / size);
    (i64::from(ax) - i64::from(bx)).pow(2) + (i64::from(ay) - i64::from(by)).pow(2)
}

proptest! {
    #[test]
    fn padding_is_the_nearest_covered_pixel(
        size in 1u32..24, seeds in proptest::collection::vec(0u32..576, 0..12), dense: bool, reach in 0u32..10
    ) {
        let mut covered = vec![false; (size * size) as usize];
        for seed in &seeds {
            covered[(seed % (size * size)) as usize] = true;
        }
        if dense {
            covered.iter_mut().enumerate().for_each(|(i, c)| *c |= i % 3 == 1);
        }
        let layout = layout(size, &covered);
        for padding in [Padding::Infinite, Padding::Texels(reach)] {
            let map = PaddingMap::new(&layout, padding);
            for pixel in 0..size * size {
                let nearest = (0..size * size)
                    .filter(|&other| covered[other as usize])
                    .map(|other| distance_squared(size, pixel, other))
                    .min();
                let limit = if padding == Padding::Infinite { i64::MAX } else { i64::from(reach * reach) };
                match nearest {
                    Some(nearest) if nearest <= limit => {
                        let source = at(&map, pixel as usize);
                        prop_assert!(source != NONE && covered[source as usize]);
                        prop_assert_eq!(distance_squared(size, pixel, source), nearest);
                    }
                    _ => prop_assert_eq!(at(&map, pixel as usize), NONE),
                }
            }
        }
    }
}

const SIZE: u32 = 128;

/// Charts of several shapes, with gaps between them from one texel on, as a map of ones over a background of zeros.
fn ones(padding: Padding) -> (Vec<bool>, Vec<f32>) {
    let covered: Vec<bool> = (0..SIZE * SIZE)
        .map(|pixel| {
            let (x, y) = ((pixel % SIZE) as i32, (pixel / SIZE) as i32);
            let is_disk = (x - 90).pow(2) + (y - 85).pow(2) < 20 * 20;
            let is_strip = (20..22).contains(&x) && (10..110).contains(&y);
            let is_triangle = x > 24 && y > 8 && x + y < 70;
            is_disk || is_strip || is_triangle || (x, y) == (110, 20)
        })
        .collect();
    let layout = layout(SIZE, &covered);
    let one = |_| [1.0, 0.0, 0.0, 0.0];
    let map = PaddingMap::new(&layout, padding).gather(&layout, &Channel::Metallic, 0, one);
    (covered, map.data)
}

/// The next mip level by averaging four texels.
fn halved(level: &[f32]) -> Vec<f32> {
    let side = level.len().isqrt();
    let mean = |at: usize| {
        let first = at / (side / 2) * 2 * side + at % (side / 2) * 2;
        (level[first] + level[first + 1] + level[first + side] + level[first + side + 1]) / 4.0
    };
    (0..level.len() / 4).map(mean).collect()
}

/// The lowest value that a bilinear lookup in a mip level finds at the corners of covered texels.
fn lowest(covered: &[bool], level: &[f32]) -> f32 {
    let side = level.len().isqrt() as i32;
    let texel = |x: i32, y: i32| level[(y.clamp(0, side - 1) * side + x.clamp(0, side - 1)) as usize];
    let lookup = |x: f32, y: f32| {
        let [x, y] = [x, y].map(|at| at * side as f32 / SIZE as f32 - 0.5);
        let (left, top, u, v) = (x.floor() as i32, y.floor() as i32, x - x.floor(), y - y.floor());
        let row = |y| texel(left, y) * (1.0 - u) + texel(left + 1, y) * u;
        row(top) * (1.0 - v) + row(top + 1) * v
    };
    let mut lowest = f32::INFINITY;
    for pixel in (0..SIZE * SIZE).filter(|pixel| covered[*pixel as usize]) {
        let (x, y) = ((pixel % SIZE) as f32, (pixel / SIZE) as f32);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5)] {
            lowest = lowest.min(lookup(x + dx, y + dy));
        }
    }
    lowest
}

#[test]
fn no_mip_level_that_the_padding_is_for_bleeds() {
    for texels in [2_u32, 4, 8, 16] {
        let (covered, mut level) = ones(Padding::Texels(texels));
        let mut first_that_bleeds = None;
        for number in 0..6_u32 {
            if lowest(&covered, &level) < 1.0 {
                first_that_bleeds = first_that_bleeds.or(Some(number));
            }
            level = halved(&level);
        }
        // A lookup reaches one and a half texels of its level out of a chart, which is 2.1 across a corner.
        let first = first_that_bleeds.unwrap();
        assert!(2_u32.pow(first) * 2 > texels, "{texels} texels: level {first} bleeds");
    }
    let (covered, mut level) = ones(Padding::Infinite);
    while level.len() > 1 {
        assert_eq!(lowest(&covered, &level), 1.0);
        assert!(level.iter().all(|&value| value == 1.0), "infinite fills all");
        level = halved(&level);
    }
}

#[test]
fn of_two_equally_near_pixels_the_left_and_the_upper_one_is_taken() {
    let covered: Vec<bool> = (0..25).map(|i| [2, 10, 14, 22].contains(&i)).collect();
    let map = PaddingMap::new(&layout(5, &covered), Padding::Infinite);
    assert_eq!(at(&map, 12), 10);
    let column: Vec<bool> = (0..25).map(|i| [2, 22].contains(&i)).collect();
    assert_eq!(at(&PaddingMap::new(&layout(5, &column), Padding::Infinite), 12), 2);
}

#[test]
fn covered_pixels_are_copies_and_the_rest_is_neutral_beyond_the_reach() {
    let covered: Vec<bool> = (0..64).map(|i| i == 9).collect();
    let layout = layout(8, &covered);
    let map = PaddingMap::new(&layout, Padding::Texels(1));
    let texel = |at: usize| std::array::from_fn(|value| (4 * at + value) as f32);
    let normal = map.gather(&layout, &Channel::Normal, 1, texel);
    assert_eq!(normal.data[27..30], [37.0, 38.0, 39.0]);
    assert_eq!(normal.data[30..33], [37.0, 38.0, 39.0]);
    assert_eq!(normal.data[33..36], [0.0, 0.0, 1.0]);
    let mut padded = normal.clone();
    padded.data[30] = f32::NAN;
    padded.data[33] = 7.0;
    map.pad(&Channel::Normal, &mut padded);
    assert_eq!(padded, normal);
}

#[test]
fn the_others_are_the_pixels_that_are_not_their_own_source() {
    const SIZE: u32 = 201;
    let covered: Vec<bool> = (0..SIZE * SIZE)
        .map(|pixel| pixel % 7 < 5 && pixel % SIZE > 3)
        .collect();
    for padding in [Padding::Infinite, Padding::Texels(2)] {
        let map = PaddingMap::new(&layout(SIZE, &covered), padding);
        assert!(map.parts.len() > 1);
        let sources = map.sources().enumerate();
        let expected: Vec<(usize, u32)> = sources.filter(|(pixel, from)| *pixel != *from as usize).collect();
        let others: Vec<(usize, u32)> = (0..map.parts.len()).flat_map(|part| map.others(part)).collect();
        assert_eq!(others, expected);
    }
}
