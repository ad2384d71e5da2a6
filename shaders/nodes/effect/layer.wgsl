//! Layer
//! Puts a layer such as rust, dust or paint over a material, where a mask is above 0.
//!
//! Each channel has its own value, mode and switch. The mask and Opacity fade from the material below to the result of the
//! mode, in linear light: where the mask is 0 nothing changes, and a soft mask has no fringe.
//! @alias layer effect rust dirt dust paint coat fill smart moss peeling
//! @use blend

struct Params {
    /// Color of the layer; Color map is multiplied by it.
    /// @color @default #808080
    color: vec3f,
    /// How the color is combined with the color below.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default normal
    color_mode: u32,
    /// Whether the layer changes the color.
    /// @toggle @default on
    color_on: u32,
    /// Roughness of the layer: 0 is a mirror, 1 is chalk; Roughness map is multiplied by it.
    /// @range 0 1 @default 0.7
    roughness: f32,
    /// How the roughness is combined with the roughness below.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default normal
    roughness_mode: u32,
    /// Whether the layer changes the roughness.
    /// @toggle @default on
    roughness_on: u32,
    /// How metallic the layer is: 0 for anything but metal, 1 for bare metal; Metallic map is multiplied by it.
    /// @range 0 1 @default 0
    metallic: f32,
    /// How the metallic value is combined with the value below.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default normal
    metallic_mode: u32,
    /// Whether the layer changes the metallic value.
    /// @toggle @default on
    metallic_on: u32,
    /// Height of the layer; Height map is multiplied by it. Below 0 the layer is sunk in.
    /// @length @range -100 100 @soft -0.05 0.05 @default 0
    height: f32,
    /// How the height is combined with the height below. There are only modes that give the same in any unit of length.
    /// @choice normal add subtract min max difference
    /// @default add
    height_mode: u32,
    /// Whether the layer changes the height.
    /// @toggle @default on
    height_on: u32,
    /// How open the layer is: 1 in the open, 0 where no light gets in; Occlusion map is multiplied by it.
    /// @range 0 1 @default 1
    occlusion: f32,
    /// How the occlusion is combined with the occlusion below.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default multiply
    occlusion_mode: u32,
    /// Whether the layer changes the occlusion.
    /// @toggle @default on
    occlusion_on: u32,
    /// Opacity of the material in the layer: 0 makes holes.
    /// @range 0 1 @default 1
    alpha: f32,
    /// How the opacity of the material is combined with the opacity below.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default normal
    alpha_mode: u32,
    /// Whether the layer changes the opacity of the material.
    /// @toggle @default off
    alpha_on: u32,
    /// Color of the light that the layer emits.
    /// @color @default #ffffff
    emission: vec3f,
    /// How the emitted light is combined with the light below.
    /// @choice normal add subtract multiply screen overlay soft_light hard_light min max difference divide
    /// @default normal
    emission_mode: u32,
    /// Whether the layer changes the emitted light.
    /// @toggle @default off
    emission_on: u32,
    /// Multiplies the emitted light.
    /// @range 0 1000 @soft 0 10 @default 1
    emission_strength: f32,
    /// Share of the layer below a clear coat, as of varnish, glaze or a film of water.
    /// @label Clear coat @range 0 1 @default 0
    coat: f32,
    /// Roughness of that coat: 0 is a mirror.
    /// @range 0 1 @default 0.05
    coat_roughness: f32,
    /// Whether the layer changes the clear coat below: see Finish below.
    /// @toggle @default on
    coat_on: u32,
    /// Strength of the fine scratches or fibers of the layer along Anisotropy direction. Highlights are drawn out across them.
    /// @range 0 1 @default 0
    anisotropy: f32,
    /// Whether the layer changes the fine scratches below: see Finish below.
    /// @toggle @default on
    anisotropy_on: u32,
    /// Color of the soft light that the layer scatters at grazing angles, as cloth and dust do; black has none.
    /// @color @default #000000
    sheen: vec3f,
    /// How far that light reaches from grazing angles.
    /// @range 0 1 @default 0.4
    sheen_roughness: f32,
    /// Whether the layer changes the sheen below: see Finish below.
    /// @toggle @default on
    sheen_on: u32,
    /// Share of the light that spreads below the surface of the layer, as in wax, marble or leaves; black has none.
    /// @color @default #000000
    subsurface: vec3f,
    /// Share of the light that goes through the layer, as through thin glass.
    /// @range 0 1 @default 0
    subsurface_transmission: f32,
    /// Whether the layer changes what lets light through below it: see Finish below.
    /// @toggle @default on
    subsurface_on: u32,
    /// Whether the layer covers the clear coat, the fine scratches, the sheen and the depth below with its own or with none. With
    /// auto it does if it has a roughness of its own, in the mode normal; a layer that only tints leaves them, and adds
    /// what it has itself.
    /// @label Finish below @choice auto cover keep @default auto
    finish_mode: u32,
    /// Whether the normal map below is kept, and Slope is added to it, or flattened as by a thick coat that has Slope alone.
    /// @label Normal map @choice keep flatten @default keep
    slope_mode: u32,
    /// Strength of Slope.
    /// @range -10 10 @soft 0 2 @default 1
    slope_strength: f32,
    /// Strength of the whole layer.
    /// @range 0 1 @default 1
    opacity: f32,
}

// The mode of the library that a choice of Height mode stands for. The other modes multiply heights by each other or
// by 1, and a length times a length is none.
fn height_blend_mode(choice: u32) -> u32 {
    // The first three are the same in both lists; in the library five others come before min.
    return select(choice, choice + 5u, choice > 2u);
}

// Whether the layer covers what the surface below has of coats, scratches, sheen and depth.
fn covers(params: Params) -> bool {
    return select(params.finish_mode == 1u, params.roughness_on != 0u && params.roughness_mode == 0u, params.finish_mode == 0u);
}

// The finish of the layer, where it has one or covers that of the surface below.
fn finished(
    layered: Material, base: Material, at: Surface, weight: f32, coat_map: f32, anisotropy_direction: vec3f, params: Params,
) -> Material {
    var result = layered;
    let is_covered = covers(params);
    if params.coat_on != 0u {
        let coat = params.coat * coat_map;
        let share = select(0.0, weight, is_covered || params.coat > 0.0);
        result.coat = clamp(mix(base.coat, coat, share), 0.0, 1.0);
        // A layer without a coat sets no channel of coats.
        let rough = params.coat_roughness * sign(params.coat);
        result.coat_roughness = mix(base.coat_roughness, rough, part_weight(base.coat, coat, share));
    }
    if params.anisotropy_on != 0u {
        let square = dot(anisotropy_direction, anisotropy_direction);
        let along = select(at.tangent.xyz, anisotropy_direction * inverseSqrt(max(square, 1e-12)), square > 1e-12);
        let share = select(0.0, weight, is_covered || params.anisotropy > 0.0);
        let sign = axis_sign(base.anisotropy, along);
        result.anisotropy = mix(base.anisotropy, params.anisotropy * (sign * along), share);
    }
    if params.sheen_on != 0u {
        let own = sheen_share(params.sheen);
        let share = select(0.0, weight, is_covered || own > 0.0);
        result.sheen = clamp(mix(base.sheen, params.sheen, share), vec3f(0.0), vec3f(1.0));
        let reach = params.sheen_roughness * sign(dot(params.sheen, vec3f(1.0)));
        result.sheen_roughness = mix(base.sheen_roughness, reach, part_weight(sheen_share(base.sheen), own, share));
    }
    if params.subsurface_on != 0u {
        let own = dot(params.subsurface, vec3f(1.0)) + params.subsurface_transmission;
        let share = select(0.0, weight, is_covered || own > 0.0);
        let spread = mix(base.subsurface, params.subsurface, share);
        result.subsurface = clamp(spread, vec3f(0.0), vec3f(1.0));
        result.transmission = mix(base.transmission, params.subsurface_transmission, share);
    }
    return result;
}

/// The material with the layer on it.
/// @input base The material underneath. @optional
/// @input mask Where the layer lies. @optional @default 1
/// @input color_map Colors of the layer. @optional @default #ffffff @starts color #ffffff
/// @input roughness_map Multiplies the roughness of the layer. @optional @default 1
/// @input metallic_map Multiplies how metallic the layer is. @optional @default 1
/// @input height_map Multiplies the height of the layer. @optional @default 1 @starts height 0.01
/// @input occlusion_map Multiplies how open the layer is, as the output AO of Occlusion does. @optional @default 1
/// @input slope Normal map of the layer, as Image and Split material give it. @vector @optional @default 0 0 0
/// @input coat_map Multiplies the clear coat of the layer. @optional @default 1
/// @input anisotropy_direction Direction of the fine scratches, as Fibers gives it; where it is 0, along the texture coordinates. @vector @optional @default 0 0 0
fn material(
    at: Surface,
    base: Material,
    mask: f32,
    color_map: vec3f,
    roughness_map: f32,
    metallic_map: f32,
    height_map: f32,
    occlusion_map: f32,
    slope: vec3f,
    coat_map: f32,
    anisotropy_direction: vec3f,
    params: Params,
) -> Material {
    let weight = blend_weight(mask, params.opacity);
    var result = base;
    if params.color_on != 0u {
        let blended = blend_color(base.base_color, params.color * color_map, params.color_mode, weight);
        result.base_color = max(blended, vec3f(0.0));
    }
    if params.roughness_on != 0u {
        let blended = blend_value(base.roughness, params.roughness * roughness_map, params.roughness_mode, weight);
        result.roughness = clamp(blended, 0.0, 1.0);
    }
    if params.metallic_on != 0u {
        let blended = blend_value(base.metallic, params.metallic * metallic_map, params.metallic_mode, weight);
        result.metallic = clamp(blended, 0.0, 1.0);
    }
    if params.height_on != 0u {
        let mode = height_blend_mode(params.height_mode);
        result.height = blend_value(base.height, params.height * height_map, mode, weight);
    }
    if params.occlusion_on != 0u {
        let blended = blend_value(base.occlusion, params.occlusion * occlusion_map, params.occlusion_mode, weight);
        result.occlusion = clamp(blended, 0.0, 1.0);
    }
    if params.alpha_on != 0u {
        result.alpha = clamp(blend_value(base.alpha, params.alpha, params.alpha_mode, weight), 0.0, 1.0);
    }
    if params.emission_on != 0u {
        let light = params.emission * params.emission_strength;
        result.emission = max(blend_color(base.emission, light, params.emission_mode, weight), vec3f(0.0));
    }
    result = finished(result, base, at, weight, coat_map, anisotropy_direction, params);
    let kept = select(1.0, 1.0 - weight, params.slope_mode != 0u);
    result.slope = base.slope * kept + slope * (params.slope_strength * weight);
    return result;
}
