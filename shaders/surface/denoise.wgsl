//! Takes the grain out of means over rays. Linked to kernels that read such means.
//! @use core surface

// Cosines of the turn of a neighbor's normal up to which it counts whole, 10 degrees, and from which on it does not, 25 degrees:
// beyond an edge a mean may rise where it falls here.
const ALIKE: f32 = 0.9848078;
const OTHER: f32 = 0.9063078;
// Distance from which on neighbors do not count, as a share of the length of the rays: over more a mean may bend. At least the next
// neighbors count, at most those that can be read, in texels.
const SHARE_OF_RAYS: f32 = 0.5;
const FEWEST_TEXELS: f32 = 1.5;
const MOST_TEXELS: f32 = 4.0;
// Squared texels added to how widely neighbors are spread: where they lie in a row, there is no slope across it.
const RIDGE: f32 = 0.05;

// The mean over rays at a place, by the plane that fits those of all texels up to two away best: unlike an average it keeps slopes,
// also beside an edge, where all neighbors lie on one side (first-order regression with weights by features, as in Bitterli et al.,
// "Nonlinearly Weighted First-order Regression for Denoising Monte Carlo Renderings", 2016). Within the range of these means. `normal`
// is the own one among `normals`, `reach` the length of the rays.
fn denoised(
    means: texture_2d_array<f32>, normals: texture_2d_array<f32>, at: Surface, normal: vec3f, reach: f32,
) -> vec3f {
    // In steps, so that rounding, which is another one on each triangle, makes no difference.
    let share = round(8.0 * SHARE_OF_RAYS * reach / at.texel_size) / 8.0;
    let across = clamp(share, FEWEST_TEXELS, MOST_TEXELS);
    let fade = 1.0 / (across * across);
    var weight = 0.0;
    var middle = vec2f(0.0);
    // Sums of x², x·y and y².
    var spread = vec3f(0.0);
    var mean = vec3f(0.0);
    var mean_x = vec3f(0.0);
    var mean_y = vec3f(0.0);
    var lowest = surface_here(means, at).xyz;
    var highest = lowest;
    for (var y = -2; y <= 2; y++) {
        for (var x = -2; x <= 2; x++) {
            let step = vec2i(x, y);
            let alike = smoothstep(OTHER, ALIKE, dot(normal, surface_neighbor(normals, at, step).xyz));
            let place = vec2f(step);
            let near = alike * max(1.0 - dot(place, place) * fade, 0.0);
            // Means that do not count may be no numbers.
            let value = select(vec3f(0.0), surface_neighbor(means, at, step).xyz, near > 0.0);
            weight += near;
            middle += near * place;
            spread += near * vec3f(place.x * place.x, place.x * place.y, place.y * place.y);
            mean += near * value;
            mean_x += near * place.x * value;
            mean_y += near * place.y * value;
            lowest = select(lowest, min(lowest, value), near > 0.0);
            highest = select(highest, max(highest, value), near > 0.0);
        }
    }
    // The texel itself counts whole, so the weight is 1 at least.
    middle /= weight;
    mean /= weight;
    let around = spread / weight - vec3f(middle.x * middle.x, middle.x * middle.y, middle.y * middle.y)
        + vec3f(RIDGE, 0.0, RIDGE);
    let along_x = mean_x / weight - middle.x * mean;
    let along_y = mean_y / weight - middle.y * mean;
    let area = around.x * around.z - around.y * around.y;
    let slope_x = (around.z * along_x - around.y * along_y) / area;
    let slope_y = (around.x * along_y - around.y * along_x) / area;
    return clamp(mean - slope_x * middle.x - slope_y * middle.y, lowest, highest);
}
