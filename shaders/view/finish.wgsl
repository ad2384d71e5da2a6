//! What few materials have: a clear coat, scratches that draw highlights out, a sheen, and light below the surface. Formulas of
//! glTF's extensions KHR_materials_clearcoat, KHR_materials_anisotropy and KHR_materials_sheen where they have one.
//! @use view/brdf view/seen view/switches

const FINISHES: u32 = COAT_MAP | ANISOTROPY_MAP | SHEEN_MAP | SUBSURFACE_MAP;

// Reflectance of a clear coat at normal incidence: a refractive index of 1.5.
const COAT_REFLECTANCE: vec3f = vec3f(0.04);
// How far past its horizon a light reaches below the surface, as a cosine, where all of it spreads there.
const SPREAD: f32 = 0.5;

fn has_finish() -> bool {
    return (MAPS & FINISHES) != 0u;
}

// A place's finish for one view of it.
struct Finish {
    // Share and roughness of the coat, and the albedo of its lobe.
    coat: vec2f,
    coat_lobe: vec2f,
    // Unit direction along which highlights are drawn out, view space, and the width of the lobe along it.
    along: vec3f,
    along_width: f32,
    // Color and roughness of the sheen, and the share of light that it takes from what lies below it.
    sheen: vec4f,
    sheen_albedo: f32,
    // Color of the light that goes through.
    clear: vec3f,
    // How far light spreads below the surface, for each of red, green and blue.
    spread: vec3f,
}

fn finish_of(spot: Spot, pixel: Pixel, made: Substance, cosine: f32) -> Finish {
    let drawn_out = pixel.tangent * spot.anisotropy.x + pixel.bitangent * spot.anisotropy.y;
    let along = unit_or(drawn_out - spot.normal * dot(drawn_out, spot.normal), vec3f(1.0, 0.0, 0.0));
    let strength = select(0.0, clamp(spot.anisotropy.z, 0.0, 1.0), has_map(ANISOTROPY_MAP));
    let width = max(made.roughness * made.roughness, 0.002);
    return Finish(
        spot.coat,
        albedo_of_lobe(cosine, spot.coat.y),
        along,
        mix(width, 1.0, strength * strength),
        spot.sheen,
        albedo_of_sheen(cosine, spot.sheen.w),
        made.diffuse * spot.subsurface.w,
        SPREAD * spot.subsurface.xyz,
    );
}

// The share of light from below that coat and sheen let pass to the eye.
fn passing(finish: Finish) -> f32 {
    let reflected = COAT_REFLECTANCE.x * finish.coat_lobe.x + finish.coat_lobe.y;
    let strongest = max(finish.sheen.x, max(finish.sheen.y, finish.sheen.z));
    return (1.0 - finish.coat.x * reflected) * (1.0 - strongest * finish.sheen_albedo);
}

// Cosine of a diffuse surface below which light spreads: it begins before the horizon, and the whole is the same.
fn spread_cosine(cosine: f32, spread: vec3f) -> vec3f {
    return max(vec3f(cosine) + spread, vec3f(0.0)) / ((1.0 + spread) * (1.0 + spread));
}

// GGX facets that are wider along one direction, over the masking of both (Burley 2012, "Physically-based shading at Disney";
// Heitz 2014, "Understanding the masking-shadowing function").
fn drawn_out_facets(finish: Finish, width: f32, normal: vec3f, to_eye: vec3f, to_light: vec3f) -> f32 {
    let half_way = normalize(to_eye + to_light);
    let beside = cross(normal, finish.along);
    let widths = vec3f(finish.along_width, width, 1.0);
    let h = vec3f(dot(finish.along, half_way), dot(beside, half_way), dot(normal, half_way)) / widths;
    let v = vec3f(dot(finish.along, to_eye), dot(beside, to_eye), max(dot(normal, to_eye), 1e-4));
    let l = vec3f(dot(finish.along, to_light), dot(beside, to_light), max(dot(normal, to_light), 1e-4));
    let facets = 1.0 / (PI * finish.along_width * width * dot(h, h) * dot(h, h));
    return facets * 0.5 / (l.z * length(widths * v) + v.z * length(widths * l));
}

// A sheen of fibers (Estevez and Kulla 2017, "Production friendly microfacet sheen BRDF"), with the masking of Neubelt and
// Pettineo 2013, "Crafting a next-gen material pipeline".
fn sheen_facets(roughness: f32, normal: vec3f, to_eye: vec3f, to_light: vec3f) -> f32 {
    let half_way = normalize(to_eye + to_light);
    let eye = max(dot(normal, to_eye), 1e-3);
    let light = max(dot(normal, to_light), 1e-3);
    let middle = clamp(dot(normal, half_way), 0.0, 1.0);
    let power = 1.0 / max(roughness * roughness, 0.005);
    let facets = (2.0 + power) * pow(max(1.0 - middle * middle, 1e-6), 0.5 * power) / (2.0 * PI);
    return facets / (4.0 * (light + eye - light * eye));
}

// Radiance that leaves towards the eye for a light of unit irradiance from one direction, with the cosine in it.
fn finished(made: Substance, lobe: vec2f, finish: Finish, normal: vec3f, to_eye: vec3f, to_light: vec3f) -> vec3f {
    let cosine = max(dot(normal, to_light), 0.0);
    let half_way = normalize(to_eye + to_light);
    var facets = visible_facets(made.roughness, normal, to_eye, to_light);
    if has_map(ANISOTROPY_MAP) {
        facets = drawn_out_facets(finish, max(made.roughness * made.roughness, 0.002), normal, to_eye, to_light);
    }
    var sum = mirrored_part(made, lobe, facets, to_light, half_way) * cosine;
    sum += diffuse_part(made, lobe) * spread_cosine(dot(normal, to_light), finish.spread);
    sum *= passing(finish);
    sum += finish.sheen.xyz * (sheen_facets(finish.sheen.w, normal, to_eye, to_light) * cosine);
    let coat = Substance(COAT_REFLECTANCE, vec3f(0.0), finish.coat.y);
    let coat_facets = visible_facets(coat.roughness, normal, to_eye, to_light);
    return sum + mirrored_part(coat, finish.coat_lobe, coat_facets, to_light, half_way) * (finish.coat.x * cosine);
}
