//! Scattering of light by a surface: a GGX lobe with height-correlated Smith shadowing over a Lambertian base, with the light that
//! bounces between facets kept (Fdez-Agüera 2019, "A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting";
//! for single lights the scale of Turquin 2019, "Practical multiple scattering compensation for microfacet models").
//! @use view/frame

struct Substance {
    // Reflectance at normal incidence, and the Lambertian base's; linear.
    specular: vec3f,
    diffuse: vec3f,
    // Perceptual: its square is the width of the lobe.
    roughness: f32,
}

fn substance_of(base_color: vec3f, metallic: f32, roughness: f32) -> Substance {
    // 0.04: a refractive index of 1.5, as glTF has it.
    let dielectric = 1.0 - metallic;
    return Substance(mix(vec3f(0.04), base_color, metallic), base_color * dielectric, roughness);
}

// Directional albedo of a sheen of white fibers.
fn albedo_of_sheen(to_eye: f32, roughness: f32) -> f32 {
    return textureSampleLevel(directional_albedo, smooth_sampler, vec2f(to_eye, roughness), 0.0).z;
}

// Directional albedo of the lobe: the part proportional to the reflectance, and the rest.
fn albedo_of_lobe(to_eye: f32, roughness: f32) -> vec2f {
    return textureSampleLevel(directional_albedo, smooth_sampler, vec2f(to_eye, roughness), 0.0).xy;
}

// Weights of the reflection and of the irradiance over π of a surrounding.
struct Surrounded {
    reflected: vec3f,
    scattered: vec3f,
}

fn surrounded(made: Substance, lobe: vec2f) -> Surrounded {
    let once = made.specular * lobe.x + lobe.y;
    let missing = 1.0 - (lobe.x + lobe.y);
    // The mean of Schlick's curve over the hemisphere.
    let mean = made.specular + (1.0 - made.specular) / 21.0;
    let again = once * mean / (1.0 - missing * mean) * missing;
    return Surrounded(once, again + made.diffuse * (1.0 - once - again));
}

// Density of the facets that mirror a light to the eye, over the masking of both.
fn visible_facets(roughness: f32, normal: vec3f, to_eye: vec3f, to_light: vec3f) -> f32 {
    let half_way = normalize(to_eye + to_light);
    let eye = max(dot(normal, to_eye), 1e-4);
    let light = max(dot(normal, to_light), 1e-4);
    let middle = clamp(dot(normal, half_way), 0.0, 1.0);
    // The reflection of a point light in a mirror would fall between pixels: it is as wide as a lamp of a few degrees.
    let width = max(roughness * roughness, 0.002);
    let square = width * width;
    let denominator = (middle * middle * (square - 1.0) + 1.0);
    let facets = square / (PI * denominator * denominator);
    let masked = light * sqrt(eye * eye * (1.0 - square) + square) + eye * sqrt(light * light * (1.0 - square) + square);
    return facets * 0.5 / masked;
}

// What a lobe loses between its facets, given back.
fn kept_between_facets(made: Substance, lobe: vec2f) -> vec3f {
    return 1.0 + made.specular * (1.0 / max(lobe.x + lobe.y, 1e-3) - 1.0);
}

// Radiance that facets mirror towards the eye for a light of unit irradiance, the cosine not yet in it.
fn mirrored_part(made: Substance, lobe: vec2f, facets: f32, to_light: vec3f, half_way: vec3f) -> vec3f {
    let grazing = pow(1.0 - clamp(dot(to_light, half_way), 0.0, 1.0), 5.0);
    let fresnel = made.specular + (1.0 - made.specular) * grazing;
    return facets * fresnel * kept_between_facets(made, lobe);
}

// The same of the Lambertian base below them.
fn diffuse_part(made: Substance, lobe: vec2f) -> vec3f {
    let let_through = 1.0 - (made.specular * lobe.x + lobe.y) * kept_between_facets(made, lobe);
    return made.diffuse * max(let_through, vec3f(0.0)) / PI;
}

// Radiance that leaves towards the eye for a light of unit irradiance from one direction, the cosine not yet in it.
fn scattered(made: Substance, lobe: vec2f, normal: vec3f, to_eye: vec3f, to_light: vec3f) -> vec3f {
    let facets = visible_facets(made.roughness, normal, to_eye, to_light);
    return mirrored_part(made, lobe, facets, to_light, normalize(to_eye + to_light)) + diffuse_part(made, lobe);
}
