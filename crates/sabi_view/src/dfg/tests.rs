//! The table, compared with closed forms and with a plain sum over half vectors.

use std::f64::consts::PI;
use std::time::Instant;

use super::{SIDE, disk_samples, integrate, integrate_sheen, table};

/// Computes the same integral over half vectors on a grid of 256 by 256 angles, weighted with the distribution of normals.
/// Light and its weight follow from them (Walter et al. 2007, equations 20 and 38). The tangent of the first angle is that
/// of the half vector divided by alpha.
fn reference(n_v: f64, roughness: f64) -> [f64; 2] {
    let alpha = roughness * roughness;
    let smith = |cos: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 / (cos * cos) - 1.0)).sqrt() - 1.0);
    let sin_v = (1.0 - n_v * n_v).sqrt();
    let mut sums = [0.0; 2];
    let steps = 256;
    let middle = |step: i32| (f64::from(step) + 0.5) / f64::from(steps);
    for (along, around) in (0..steps).flat_map(|along| (0..steps).map(move |around| (along, around))) {
        let angle = 0.5 * PI * middle(along);
        let share = 0.5 * PI * (2.0 * angle).sin();
        let tangent = alpha * angle.tan();
        let cos_h = 1.0 / (1.0 + tangent * tangent).sqrt();
        let sin_h = tangent * cos_h;
        let v_h = sin_v * sin_h * (PI * middle(around)).cos() + n_v * cos_h;
        let n_l = 2.0 * v_h * cos_h - n_v;
        if v_h > 0.0 && n_l > 0.0 {
            let weight = share * v_h / (n_v * cos_h) / (1.0 + smith(n_l) + smith(n_v));
            let fresnel = (1.0 - v_h).powi(5);
            sums[0] += weight * (1.0 - fresnel);
            sums[1] += weight * fresnel;
        }
    }
    sums.map(|sum| sum / f64::from(steps * steps))
}

#[test]
fn the_table_agrees_with_a_fine_sum() {
    let mut worst = [0.0f64; 2];
    for roughness in [0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0] {
        for n_v in [0.004, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 0.99] {
            let (own, expected) = (integrate(&disk_samples(), n_v, roughness), reference(n_v, roughness));
            for part in 0..2 {
                let error = (own[part] - expected[part]).abs();
                worst[part] = worst[part].max(error);
                assert!(
                    error < 2e-3,
                    "roughness {roughness}, cosine {n_v}: {own:?} and {expected:?}"
                );
            }
        }
    }
    println!("largest errors {worst:?}");
}

/// A mirror of roughness 1 reflects 1 - mu ln((1 + mu) / mu) of the light in one bounce.
#[test]
fn roughness_1_agrees_with_its_closed_form() {
    for n_v in [0.05, 0.2, 0.5, 0.8, 1.0f64] {
        let [scale, bias] = integrate(&disk_samples(), n_v, 1.0);
        let expected = 1.0 - n_v * ((1.0 + n_v) / n_v).ln();
        let error = scale + bias - expected;
        assert!(error.abs() < 1e-3, "cosine {n_v}: {error}");
    }
}

#[test]
fn no_more_light_is_reflected_than_arrives() {
    let started = Instant::now();
    let table = table();
    println!("the table took {:?}", started.elapsed());
    assert_eq!(table.len(), (SIDE * SIDE) as usize);
    for [scale, bias, sheen] in table {
        assert!((0.0..=1.0).contains(sheen), "a sheen of {sheen}");
        assert!(
            *scale >= 0.0 && *bias >= 0.0 && scale + bias <= 1.0 + 1e-6,
            "{scale} {bias}"
        );
    }
}

/// Returns the reflected light, including light that bounces more than once (Fdez-Agüera 2019, A Multiple-Scattering
/// Microfacet Model for Real-Time Image-based Lighting), under light of 1 from all directions.
fn furnace([scale, bias]: [f32; 2], f0: f32, albedo: f32) -> f32 {
    let once = f0 * scale + bias;
    let lost = 1.0 - scale - bias;
    let mean = f0 + (1.0 - f0) / 21.0;
    let more = once * mean / (1.0 - lost * mean);
    once + more * lost + albedo * (1.0 - once - more * lost)
}

#[test]
fn white_metal_and_white_plastic_are_invisible_in_a_white_furnace() {
    for entry in table() {
        let [scale, bias, _] = *entry;
        for (f0, albedo) in [(1.0, 0.0), (0.04, 1.0)] {
            let seen = furnace([scale, bias], f0, albedo);
            assert!((seen - 1.0).abs() < 0.01, "F0 {f0}, albedo {albedo}: {seen}");
        }
    }
}

/// At roughness 1 the distribution is 3 sin / 2π. Seen from straight above, light at an angle θ has its half vector at θ /
/// 2, and the masking is 1 / 4.
#[test]
fn a_sheen_seen_from_straight_above_equals_its_integral() {
    let steps = 100_000;
    let middle = |step: i32| (f64::from(step) + 0.5) / f64::from(steps);
    let sum: f64 = (0..steps)
        .map(|step| {
            let angle: f64 = 0.5 * PI * middle(step);
            3.0 * (0.5 * angle).sin() / 4.0 * angle.cos() * angle.sin()
        })
        .sum();
    let expected = sum * 0.5 * PI / f64::from(steps);
    let own = integrate_sheen(1.0, 1.0);
    assert!((own - expected).abs() < 1e-3, "{own}, not {expected}");
}

#[test]
fn a_sheen_is_strongest_at_grazing_angles() {
    for roughness in [0.2, 0.5, 0.9] {
        let [grazing, above] = [0.1, 0.9].map(|n_v| integrate_sheen(n_v, roughness));
        assert!(grazing > 1.5 * above, "roughness {roughness}: {grazing} and {above}");
    }
}
