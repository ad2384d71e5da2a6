//! A model seen from the front at an angle, its textures on it, lit softly. Orthographic, on the CPU.

use glam::{DQuat, DVec2, DVec3, dvec2, dvec3};

use super::picture::{Texture, linear_from_srgb, srgb8_from_linear};
use crate::models::glb::{Model, index};

/// Pixels of a finished picture's side, and samples a pixel along each axis.
pub(crate) const SIDE: usize = 288;
const SAMPLES: usize = 2;
/// Behind the model, as sRGB codes.
const BACKDROP: [u8; 3] = [236, 234, 230];

/// Appearance of one material of a model.
#[derive(Clone, Debug)]
pub(crate) enum ReferenceLook {
    /// Values to be seen as they are, in light that hides nothing.
    Flat(Texture),
    /// A material to be judged.
    Lit {
        /// sRGB.
        base_color: Texture,
        roughness: Texture,
        metallic: Texture,
        /// Tangent space, y up.
        normal: Texture,
    },
}

/// A corner of a triangle: where it is seen (x right, y down, z toward the eye, in samples), its frame and texture place.
#[derive(Clone, Copy, Debug)]
struct ScreenCorner {
    seen: DVec3,
    normal: DVec3,
    uv: DVec2,
}

/// Renders a model; one look a material.
pub(crate) fn render(model: &Model, looks: &[ReferenceLook]) -> Vec<[u8; 3]> {
    let side = SIDE * SAMPLES;
    let mut colors = vec![DVec3::from(BACKDROP.map(|code| linear_from_srgb(f64::from(code) / 255.0))); side * side];
    let mut depths = vec![f64::NEG_INFINITY; side * side];
    for (triangle, material) in triangles(model, side as f64) {
        if let Some(look) = looks.get(material) {
            draw(&triangle, look, side, &mut colors, &mut depths);
        }
    }
    let pixel = |at: usize| {
        let (x, y) = (at % SIDE * SAMPLES, at / SIDE * SAMPLES);
        let mut sum = DVec3::ZERO;
        for j in 0..SAMPLES {
            for i in 0..SAMPLES {
                sum += colors[(y + j) * side + x + i].min(DVec3::ONE);
            }
        }
        (sum / (SAMPLES * SAMPLES) as f64).to_array().map(srgb8_from_linear)
    };
    (0..SIDE * SIDE).map(pixel).collect()
}

/// All triangles with the number of their material, turned toward the eye and scaled to fill the picture.
fn triangles(model: &Model, side: f64) -> Vec<([ScreenCorner; 3], usize)> {
    let view = DQuat::from_rotation_x(22f64.to_radians()) * DQuat::from_rotation_y(36f64.to_radians());
    let mut all = Vec::new();
    for (part, indexed) in model.parts.iter().zip(index(model)) {
        let turn = view * part.rotation;
        let corner = |&i: &u32| {
            let i = i as usize;
            let own = DVec3::from(indexed.positions[i].map(f64::from));
            ScreenCorner {
                seen: view * part.translation + turn * own,
                normal: turn * DVec3::from(indexed.normals[i].map(f64::from)),
                uv: DVec2::from(indexed.uvs[i].map(f64::from)),
            }
        };
        let faces = indexed.indices.as_chunks::<3>().0.iter();
        all.extend(faces.map(|[a, b, c]| ([corner(a), corner(b), corner(c)], part.material)));
    }
    let seen = || {
        all.iter()
            .flat_map(|(triangle, _)| triangle.iter().map(|corner| corner.seen))
    };
    let (low, high) = seen().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| {
        (low.min(at), high.max(at))
    });
    let scale = side * 0.94 / (high - low).truncate().max_element();
    let middle = (low + high) / 2.0;
    for (triangle, _) in &mut all {
        for corner in triangle {
            let own = (corner.seen - middle) * scale;
            corner.seen = dvec3(side / 2.0 + own.x, side / 2.0 - own.y, own.z);
        }
    }
    all
}

fn draw(corners: &[ScreenCorner; 3], look: &ReferenceLook, side: usize, colors: &mut [DVec3], depths: &mut [f64]) {
    let at = corners.map(|corner| corner.seen.truncate());
    let area = (at[1] - at[0]).perp_dot(at[2] - at[0]);
    // y points down, so what faces the eye turns the other way.
    if area >= -1e-9 {
        return;
    }
    let low = at[0].min(at[1]).min(at[2]).max(DVec2::ZERO);
    let high = at[0].max(at[1]).max(at[2]).min(DVec2::splat(side as f64 - 1.0));
    for y in low.y as usize..=high.y.max(0.0) as usize {
        for x in low.x as usize..=high.x.max(0.0) as usize {
            let place = dvec2(x as f64 + 0.5, y as f64 + 0.5);
            let one = (place - at[0]).perp_dot(at[2] - at[0]) / area;
            let other = (at[1] - at[0]).perp_dot(place - at[0]) / area;
            let weights = [1.0 - one - other, one, other];
            if weights.iter().any(|weight| *weight < 0.0) {
                continue;
            }
            let depth: f64 = (0..3).map(|i| corners[i].seen.z * weights[i]).sum();
            if depth <= depths[y * side + x] {
                continue;
            }
            depths[y * side + x] = depth;
            let normal: DVec3 = (0..3).map(|i| corners[i].normal * weights[i]).sum();
            let uv: DVec2 = (0..3).map(|i| corners[i].uv * weights[i]).sum();
            colors[y * side + x] = shade(look, normal.normalize_or_zero(), uv, corners);
        }
    }
}

/// Direction to the main light and to the one that fills its shadows; the eye is at +z.
const KEY: DVec3 = dvec3(-0.48, 0.66, 0.58);
const FILL: DVec3 = dvec3(0.8, 0.15, 0.58);

fn shade(look: &ReferenceLook, normal: DVec3, uv: DVec2, corners: &[ScreenCorner; 3]) -> DVec3 {
    match look {
        ReferenceLook::Flat(texture) => {
            let color = texture.sample(uv).to_array().map(linear_from_srgb);
            let light = 0.6 + 0.34 * normal.dot(KEY).max(0.0) + 0.1 * normal.dot(FILL).max(0.0);
            // Black would show no shape at all.
            (DVec3::from(color) * 0.975 + 0.025) * light
        }
        ReferenceLook::Lit {
            base_color,
            roughness,
            metallic,
            normal: map,
        } => {
            let color = DVec3::from(base_color.sample(uv).to_array().map(linear_from_srgb));
            let bent = bent_normal(map.sample(uv) * 2.0 - 1.0, normal, corners);
            lit(color, roughness.sample(uv).x, metallic.sample(uv).x, bent)
        }
    }
}

/// A tangent-space normal in the picture's space.
fn bent_normal(own: DVec3, normal: DVec3, corners: &[ScreenCorner; 3]) -> DVec3 {
    let place = corners.map(|corner| corner.seen * dvec3(1.0, -1.0, 1.0));
    let (one, other) = (place[1] - place[0], place[2] - place[0]);
    let (du, dv) = (corners[1].uv - corners[0].uv, corners[2].uv - corners[0].uv);
    let turn = du.perp_dot(dv);
    if turn.abs() < 1e-14 {
        return normal;
    }
    let along_u = (one * dv.y - other * du.y) / turn;
    let tangent = (along_u - normal * normal.dot(along_u)).normalize_or_zero();
    // v points down in the file and the map's y points up; a mirrored chart turns its frame over.
    let bitangent = normal.cross(tangent) * -turn.signum();
    (tangent * own.x + bitangent * own.y + normal * own.z).normalize_or(normal)
}

/// A plain studio: two lights and a sky, reflected by Schlick's and the GGX approximations.
fn lit(color: DVec3, roughness: f64, metallic: f64, normal: DVec3) -> DVec3 {
    let eye = DVec3::Z;
    let facing = normal.dot(eye).max(0.05);
    let mirrored = DVec3::splat(0.04).lerp(color, metallic);
    let diffuse = color * (1.0 - metallic);
    let alpha = (roughness * roughness).max(0.02);
    let sky = |direction: DVec3| {
        let horizon = 0.5 + 0.5 * direction.y;
        let window = (1.0 - (direction.y - 0.55).abs() * (3.0 - 2.0 * roughness)).max(0.0);
        0.18 + 0.42 * horizon + 0.55 * window * (1.0 - 0.6 * roughness)
    };
    let mut sum = diffuse * (0.2 + 0.16 * normal.y);
    for (toward, strength) in [(KEY, 2.4), (FILL, 0.55)] {
        let light = normal.dot(toward).max(0.0);
        let half = (toward + eye).normalize_or_zero();
        let across = normal.dot(half).max(0.0);
        let spread = across * across * (alpha * alpha - 1.0) + 1.0;
        let density = alpha * alpha / (std::f64::consts::PI * spread * spread);
        let fresnel = mirrored + (DVec3::ONE - mirrored) * (1.0 - half.dot(eye).max(0.0)).powi(5);
        sum += (diffuse / std::f64::consts::PI + fresnel * density.min(8.0) * 0.25) * light * strength;
    }
    let rim = mirrored + (DVec3::ONE - mirrored) * (1.0 - facing).powi(5) * (1.0 - roughness) * 0.6;
    let reflected = normal * 2.0 * normal.dot(eye) - eye;
    sum + rim * sky(reflected) * 0.8
}
