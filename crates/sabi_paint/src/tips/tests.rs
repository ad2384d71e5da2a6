//! Stamps of all tips, asked for on a grid.

use glam::{DVec2, DVec3};

use super::{Spot, Stamp, Tip};
use crate::brush::{Brush, TipDirection};

/// Texels along a radius.
const FINE: i32 = 64;

/// Strengths of a stamp that is faded by its own hardness, at the middles of texels from −1.25 to 1.25 radii.
fn picture(tip: Tip, seeds: [u32; 2], texels: i32) -> Vec<(DVec2, f64)> {
    let (stamp, brush) = (tip.stamp(seeds), Brush::default().with_tip(tip));
    let side = texels + texels / 4;
    let places = (-side..side).flat_map(|y| (-side..side).map(move |x| (x, y)));
    let places = places.map(|(x, y)| (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / f64::from(texels));
    let strength = |q: DVec2| stamp.strength(&spot(tip, &brush, q, q.extend(0.0), f64::from(texels)));
    places.map(|q| (q, strength(q))).collect()
}

fn spot(tip: Tip, brush: &Brush, q: DVec2, model: DVec3, texels: f64) -> Spot {
    let distance = if tip == Tip::Square {
        q.abs().max_element()
    } else {
        q.length()
    };
    Spot {
        q,
        model,
        normal: DVec3::Z,
        grain: tip.grain().map_or(0.0, |grain| grain(model, 1.0 / texels)),
        texel: 1.0 / texels,
        fall: brush.falloff(distance),
    }
}

/// Mean strength within the radius.
fn cover(picture: &[(DVec2, f64)]) -> f64 {
    let inside = picture.iter().filter(|(q, _)| q.length() < 1.0);
    let (sum, count) = inside.fold((0.0, 0), |(sum, count), (_, strength)| (sum + strength, count + 1));
    sum / f64::from(count)
}

fn rms(differences: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = differences.fold((0.0, 0), |(sum, count), value| (sum + value * value, count + 1));
    (sum / f64::from(count)).sqrt()
}

#[test]
fn strengths_are_shares_and_nothing_is_painted_beyond_the_radius() {
    for (tip, name) in Tip::ALL {
        for stamp in 0..6 {
            for (q, strength) in picture(tip, [77, stamp], 32) {
                assert!((0.0..=1.0).contains(&strength), "{name}: {strength} at {q}");
                let is_outside = if tip == Tip::Square {
                    q.abs().max_element() >= 1.0
                } else {
                    q.length() >= 1.0
                };
                assert!(!is_outside || strength == 0.0, "{name}: {strength} at {q}");
            }
        }
    }
}

#[test]
fn no_tip_but_the_plain_ones_is_cut_off_by_the_border() {
    for (tip, name) in Tip::ALL {
        if matches!(tip, Tip::Round | Tip::Square | Tip::Soft | Tip::Bristles) {
            continue;
        }
        // Strength of single stamps just inside of the border.
        let rim = (0..6).flat_map(|stamp| picture(tip, [5, stamp], 32));
        let rim: Vec<f64> = rim
            .filter(|(q, _)| (0.97..1.0).contains(&q.length()))
            .map(|(_, strength)| strength)
            .collect();
        let mean = rim.iter().sum::<f64>() / rim.len() as f64;
        assert!(mean < 0.02, "{name}: {mean}");
    }
}

#[test]
fn every_tip_paints_something_and_only_plain_ones_paint_nearly_all() {
    for (tip, name) in Tip::ALL {
        for stamp in 0..12 {
            let share = cover(&picture(tip, [3, stamp], 32));
            let most = match tip {
                Tip::Round | Tip::Square => 1.0,
                _ => 0.62,
            };
            assert!(share > 0.01 && share <= most, "{name}: {share}");
        }
    }
}

#[test]
fn no_two_tips_look_the_same() {
    let pictures = Tip::ALL.map(|(tip, name)| (name, picture(tip, [9, 1], 32)));
    for (index, (name, own)) in pictures.iter().enumerate() {
        for (other_name, other) in &pictures[..index] {
            let difference = rms(own.iter().zip(other).map(|((_, own), (_, other))| own - other));
            // 1 for two that have nothing to do with each other.
            let both = [own, other].map(|picture| rms(picture.iter().map(|(_, strength)| *strength)));
            let share = difference / both[0].hypot(both[1]);
            assert!(share > 0.2, "{name} and {other_name}: {share}");
        }
    }
}

/// Tips that depend on nothing but the place in the model and the distance from the middle.
fn stays_on_the_model(tip: Tip) -> bool {
    matches!(tip, Tip::Chalk | Tip::Crackle | Tip::Moss)
}

#[test]
fn stamps_of_the_same_numbers_are_the_same_and_others_differ() {
    for (tip, name) in Tip::ALL {
        let first = picture(tip, [1, 2], 32);
        assert_eq!(first, picture(tip, [1, 2], 32), "{name}");
        let difference = |seeds: [u32; 2]| {
            let other = picture(tip, seeds, 32);
            rms(first.iter().zip(&other).map(|((_, own), (_, other))| own - other))
        };
        // Hairs belong to the stroke, and so lie behind each other in all of its stamps.
        let is_of_the_stroke = matches!(tip, Tip::Bristles | Tip::DryBrush);
        let is_plain = matches!(tip, Tip::Round | Tip::Soft | Tip::Square) || stays_on_the_model(tip);
        assert_eq!(difference([1, 3]) > 0.03, !is_plain && !is_of_the_stroke, "{name}");
        assert_eq!(difference([4, 2]) > 0.03, !is_plain, "{name}");
    }
}

#[test]
fn grains_of_the_model_stay_where_they_are_under_another_stamp() {
    for (tip, name) in Tip::ALL.into_iter().filter(|(tip, _)| stays_on_the_model(*tip)) {
        let stamps: [Stamp; 2] = [tip.stamp([1, 0]), tip.stamp([1, 7])];
        // Both stamps cover the place in full, at another place of theirs.
        let at = |stamp: &Stamp, q: DVec2, model: DVec3| {
            stamp.strength(&Spot {
                q,
                model,
                normal: DVec3::Z,
                grain: tip.grain().map_or(0.0, |grain| grain(model, 0.02)),
                texel: 0.02,
                fall: 1.0,
            })
        };
        for index in 0..400 {
            let model = DVec3::new(f64::from(index % 20), f64::from(index / 20), 3.0) * 0.083;
            let strengths = [
                at(&stamps[0], DVec2::new(0.1, 0.2), model),
                at(&stamps[1], DVec2::new(-0.3, 0.05), model),
            ];
            assert_eq!(strengths[0], strengths[1], "{name} at {model}");
        }
    }
}

#[test]
fn texels_of_half_the_size_show_the_same_on_average() {
    for (tip, name) in Tip::ALL {
        let [coarse, fine] = [FINE / 2, FINE].map(|texels| picture(tip, [11, 4], texels));
        let row = 2 * (FINE + FINE / 4) as usize;
        let averaged = (0..coarse.len()).map(|index| {
            let (x, y) = (2 * (index % (row / 2)), 2 * (index / (row / 2)));
            let four = [0, 1, row, row + 1].map(|offset| fine[y * row + x + offset].1);
            four.iter().sum::<f64>() / 4.0
        });
        let difference = rms(coarse.iter().zip(averaged).map(|((_, coarse), fine)| coarse - fine));
        assert!(difference < 0.06, "{name}: {difference}");
        let shares = [&coarse, &fine].map(|picture| cover(picture));
        assert!((shares[0] / shares[1] - 1.0).abs() < 0.15, "{name}: {shares:?}");
    }
}

#[test]
fn names_in_files_stay_and_files_from_before_read_as_they_did() {
    for (tip, name) in Tip::ALL {
        let text = serde_json::to_string(&tip).unwrap();
        assert_eq!(serde_json::from_str::<Tip>(&text).unwrap(), tip, "{name}");
    }
    let old = ["round", "square", "chalk", "bristles", "splatter", "spray"];
    let tips = old.map(|name| serde_json::from_str::<Tip>(&format!("\"{name}\"")).unwrap());
    use Tip::*;
    assert_eq!(tips, [Round, Square, Chalk, Bristles, Splatter, Spray]);
    let brush: Brush = serde_json::from_str(r#"{"tip": "chalk", "spacing": 0.1}"#).unwrap();
    assert_eq!((brush.tip, brush.turn), (Chalk, TipDirection::Stroke));
    // The name of a version is a hash of these bytes.
    assert!(!serde_json::to_string(&brush).unwrap().contains("\"turn\""));
    let hanging = brush.with_tip(Drips);
    let text = serde_json::to_string(&hanging).unwrap();
    assert_eq!(serde_json::from_str::<Brush>(&text).unwrap(), hanging);
}

#[test]
fn settings_that_suit_a_tip_are_within_bounds_and_those_of_the_round_one_are_usual() {
    let usual = Brush::default();
    for (tip, name) in Tip::ALL {
        let brush = usual.with_tip(tip);
        assert_eq!(brush, brush.bounded(), "{name}");
        assert_eq!(brush.with_tip(Tip::Round), usual, "{name}");
    }
}
