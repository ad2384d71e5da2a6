use super::read;
use crate::kind::Channel;

/// Returns the channels that a material function with this body sets, each with the toggles (0 `one`, 1 `two`) that must be on.
fn channels(body: &str) -> Vec<(Channel, Vec<usize>)> {
    let text = format!(
        "struct Params {{\n/// O.\n/// @toggle @default on\none: u32,\n/// T.\n/// @toggle @default on\ntwo: u32,\n/// M.\n/// @choice a b @default a\nmode: u32,\n}}\n\
         fn mixed(a: Material, b: Material, t: f32) -> Material {{ return Material(mix(a.base_color, b.base_color, t), mix(a.alpha, b.alpha, t), \
         mix(a.roughness, b.roughness, t), mix(a.metallic, b.metallic, t), mix(a.occlusion, b.occlusion, t), mix(a.height, b.height, t), mix(a.slope, b.slope, t), mix(a.emission, b.emission, t), \
         mix(a.coat, b.coat, t), mix(a.coat_roughness, b.coat_roughness, t), mix(a.anisotropy, b.anisotropy, t), mix(a.sheen, b.sheen, t), \
         mix(a.sheen_roughness, b.sheen_roughness, t), mix(a.subsurface, b.subsurface, t), mix(a.transmission, b.transmission, t)); }}\n\
         /// Keeps all used.\nfn keep(params: Params) -> f32 {{ return f32(params.one + params.two + params.mode); }}\n\
         /// Material.\n/// @input base One. @input other Two. @input t Mix.\nfn material(base: Material, other: Material, t: f32, params: Params) -> Material {{\n\
         let all = base.alpha + other.alpha + t;\nif all > 1e30 {{ return base; }}\n{body}\n}}\n"
    );
    let kind = read(&text).unwrap();
    let output = kind.output(Some("material")).unwrap();
    assert!(kind.output(Some("keep")).unwrap().channels.is_empty());
    output
        .channels
        .iter()
        .map(|write| (write.channel, write.unless_off.clone()))
        .collect()
}

#[test]
fn a_copied_material_sets_nothing() {
    for body in [
        "return base;",
        "var result = base; return result;",
        "var result = base; result = other; return result;",
        "return plain_material();",
        "return mixed(base, other, t);",
        "var result = mixed(base, plain_material(), t); result.height = base.height; return result;",
        "var result = base; result.height = mix(result.height, other.height, t); return result;",
        "var result = base; result.slope = base.slope * (1.0 - t); return result;",
        "var result = base; result.height = select(base.height, other.height * 2.0 + base.height, t > 0.5); return result;",
        "var result = base; if params.one != 0u { result.base_color = other.base_color; } return result;",
        "var result = base; result.emission = vec3f(0.0); result.height = -other.height; return result;",
        "var height = base.height; if t > 0.5 { height = other.height; } var result = base; result.height = height; return result;",
    ] {
        assert_eq!(channels(body), [], "{body}");
    }
}

#[test]
fn a_stored_channel_counts_as_set() {
    let all = |channel| vec![(channel, vec![])];
    for (body, expected) in [
        (
            "var result = base; result.height = t; return result;",
            all(Channel::Height),
        ),
        (
            "var result = base; result.base_color.x = t; return result;",
            all(Channel::Color),
        ),
        (
            "var result = base; result.roughness = base.metallic; return result;",
            all(Channel::Surface),
        ),
        (
            "var result = base; result.slope = base.emission; return result;",
            all(Channel::Slope),
        ),
        (
            "var result = base; let p = &result.emission; *p = vec3f(t); return result;",
            all(Channel::Emission),
        ),
        (
            "var result = base; result.height += t; return result;",
            all(Channel::Height),
        ),
        (
            "var result = base; result.base_color += vec3f(0.0); return result;",
            all(Channel::Color),
        ),
        (
            "return Material(vec3f(t), 1.0, t, 0.0, 1.0, 0.0, vec3f(0.0), vec3f(0.0), \
             0.0, 0.0, vec3f(0.0), vec3f(0.0), 0.0, vec3f(0.0), 0.0);",
            vec![(Channel::Color, vec![]), (Channel::Surface, vec![])],
        ),
        (
            "var result: Material; result.base_color = base.base_color; return result;",
            vec![(Channel::Color, vec![]), (Channel::Surface, vec![])],
        ),
    ] {
        assert_eq!(channels(body), expected, "{body}");
    }
}

#[test]
fn toggles_around_a_store_are_found() {
    let under = |toggles: &[usize]| vec![(Channel::Height, toggles.to_vec())];
    for (body, toggles) in [
        (
            "var r = base; if params.one != 0u { r.height = t; } return r;",
            &[0][..],
        ),
        ("var r = base; if params.one == 1u { r.height = t; } return r;", &[0]),
        ("var r = base; if params.one > 0u { r.height = t; } return r;", &[0]),
        ("var r = base; if 0u < params.one { r.height = t; } return r;", &[0]),
        ("var r = base; if bool(params.one) { r.height = t; } return r;", &[0]),
        (
            "var r = base; if params.one == 0u { r.height = other.height; } else { r.height = t; } return r;",
            &[0],
        ),
        ("var r = base; if !(params.one == 0u) { r.height = t; } return r;", &[0]),
        (
            "var r = base; if params.one != 0u { if params.two != 0u { r.height = t; } } return r;",
            &[0, 1],
        ),
        (
            "var r = base; if params.one != 0u && params.two != 0u { r.height = t; } return r;",
            &[0, 1],
        ),
        (
            "var r = base; if params.one != 0u && t > 0.5 { r.height = t; } return r;",
            &[0],
        ),
        (
            "let on = params.one != 0u; var r = base; if on { r.height = t; } return r;",
            &[0],
        ),
        (
            "var r = base; r.height = select(base.height, t, params.two != 0u); return r;",
            &[1],
        ),
        (
            "if params.one != 0u { var r = base; r.height = t; return r; } return base;",
            &[0],
        ),
        (
            "var h = base.height; if params.one != 0u { h = t; } var r = base; r.height = h; return r;",
            &[0],
        ),
    ] {
        assert_eq!(channels(body), under(toggles), "{body}");
    }
}

#[test]
fn conditions_other_than_single_toggles_being_on_are_ignored() {
    for body in [
        "var r = base; if params.one != 0u { r.height = t; } if params.two != 0u { r.height = t; } return r;",
        "var r = base; if params.one != 0u || params.two != 0u { r.height = t; } return r;",
        "var r = base; if params.one == 0u { r.height = t; } return r;",
        "var r = base; if params.mode != 0u { r.height = t; } return r;",
        "var r = base; if params.one != 1u { r.height = t; } return r;",
        "var r = base; if 0u > params.one { r.height = t; } return r;",
    ] {
        assert_eq!(channels(body), [(Channel::Height, vec![])], "{body}");
    }
}

#[test]
fn a_channel_needs_the_numbers_that_may_be_zero() {
    let needs = |body: &str| {
        let text = format!(
            "struct Params {{\n/// D.\n/// @default 0\ndepth: f32,\n/// W.\n/// @default 0 0 0\nway: vec3f,\n}}\n\
             /// Material.\n/// @input base One. @input t Height. @input light Light.\n\
             fn material(base: Material, t: f32, light: vec3f, params: Params) -> Material {{\n\
             if t + light.x + params.depth + params.way.x + base.alpha > 1e30 {{ return base; }}\n\
             var r = base; {body} return r; }}\n"
        );
        let kind = read(&text).unwrap();
        let [write] = kind.outputs[0].channels.as_slice() else {
            panic!("{body}: {:?}", kind.outputs[0].channels)
        };
        let named = |inputs: &[usize]| {
            inputs
                .iter()
                .map(|at| kind.inputs[*at].name.clone())
                .collect::<Vec<_>>()
        };
        (write.unless_off.clone(), named(&write.unless_open))
    };
    for (body, params, inputs) in [
        ("r.height = t;", &[][..], &["t"][..]),
        ("r.emission = max(light, vec3f(0.0));", &[], &["light"]),
        ("r.height = base.height + params.depth * t;", &[0], &["t"]),
        ("r.height = base.height * (t - 1.0) + params.depth;", &[0], &[]),
        ("let h = params.depth * 2.0; r.height += h;", &[0], &[]),
        ("r.slope = params.way * t;", &[1], &["t"]),
        (
            "r.coat = clamp(mix(base.coat, params.depth * t, 0.5), 0.0, 1.0);",
            &[0],
            &["t"],
        ),
        (
            "r.sheen_roughness = 0.5 * sign(dot(params.way, vec3f(1.0)));",
            &[1],
            &[],
        ),
        // Two members belong to one channel; the channel needs only what both need.
        ("r.coat = t; r.coat_roughness = params.depth * t;", &[], &["t"]),
        // The channel is set if either of the two numbers is not zero, so neither is needed.
        ("r.height = t + params.depth;", &[], &[]),
        ("r.height = t + 1.0;", &[], &[]),
        // The plain material's roughness is not zero, so setting it to zero is a change.
        ("r.roughness = t;", &[], &[]),
    ] {
        assert_eq!(
            needs(body),
            (params.to_vec(), inputs.iter().map(|name| (*name).to_owned()).collect()),
            "{body}"
        );
    }
}

#[test]
fn code_that_the_analysis_cannot_follow_counts_as_always_set() {
    let body = "var list = array<Material, 2>(base, other); return list[u32(t)];";
    let set: Vec<Channel> = channels(body).into_iter().map(|(channel, _)| channel).collect();
    assert_eq!(set, Channel::ALL);
}

#[test]
fn members_of_one_channel_with_different_needs_each_set_it() {
    let text = "struct Params {\n/// S.\n/// @color @default #000000\nspread: vec3f,\n/// T.\n/// @default 0\nthrough: f32,\n}\n\
                /// Material.\n/// @input base One.\nfn material(base: Material, params: Params) -> Material {\n\
                var r = base; r.subsurface = params.spread; r.transmission = params.through; return r; }\n";
    let kind = read(text).unwrap();
    let needs: Vec<_> = kind.outputs[0]
        .channels
        .iter()
        .map(|write| (write.channel, write.unless_off.clone()))
        .collect();
    assert_eq!(needs, [(Channel::Subsurface, vec![0]), (Channel::Subsurface, vec![1])]);
}
