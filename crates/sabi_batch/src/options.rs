//! Options of a matrix: settings of a bake besides graph, model, values, size and presets.

use std::path::Path;

use sabi_engine::baking::BakeRequest;
use sabi_engine::baking::Seams;
use sabi_engine::opening::linked_model::Overlap;
use sabi_engine::source::without_paint;
use sabi_export::CopyOptions;
use sabi_graph::{Fit, nearest};
use sabi_surface::atlas::Udim;
use sabi_surface::load::{Up, is_smoothing_angle};
use serde_json::{Map, Value as Json};

/// Options that are set, by name.
pub(crate) type ItemOptions = Map<String, Json>;

/// Sets an option of a request. Returns `None` for a value that it does not accept.
type Apply = fn(&mut BakeRequest, &Json) -> Option<()>;

/// An option: its name, a description of the values that it accepts, and its effect.
struct ItemOption {
    name: &'static str,
    takes: &'static str,
    apply: Apply,
}

const fn option(name: &'static str, takes: &'static str, apply: Apply) -> ItemOption {
    ItemOption { name, takes, apply }
}

const OPTIONS: [ItemOption; 22] = [
    option("all_maps", "true or false", |request, value| {
        request.all_maps = value.as_bool()?;
        Some(())
    }),
    option("channels", "a list of channels", |request, value| {
        request.channels = texts(value)?;
        Some(())
    }),
    option("embed", "true or false", |request, value| {
        let embeds = value.as_bool()?;
        if let Some(copy) = &mut request.model {
            copy.embeds = embeds;
        }
        Some(())
    }),
    option(
        "fit",
        "'unit', 'metres', 'piece' or a length above 0",
        |request, value| {
            request.evaluator.fit = Some(match value.as_str() {
                Some("unit") => Fit::Unit,
                Some("metres" | "meters") => Fit::Metres,
                Some("piece") => Fit::Piece,
                Some(_) => return None,
                None => Fit::Length(above_zero(value)?),
            });
            Some(())
        },
    ),
    option("keep_look", "true or false", |request, value| {
        let keeps_look = value.as_bool()?;
        if let Some(copy) = &mut request.model {
            copy.keeps_look = keeps_look;
        }
        Some(())
    }),
    option("material", "the name of a material of the model", |request, value| {
        request.material = Some(value.as_str()?.to_owned());
        Some(())
    }),
    option("mesh_maps", "a list of maps of the model", |request, value| {
        request.mesh_maps = texts(value)?;
        Some(())
    }),
    option("names", "a pattern for the names of maps", |request, value| {
        request.names = Some(value.as_str()?.to_owned());
        Some(())
    }),
    option("no_paint", "true or false", |request, value| {
        let left_out = value.as_bool()?.then(without_paint);
        request.evaluator.overrides.left_out = left_out.into_iter().collect();
        Some(())
    }),
    option("overlap", "'auto', 'first', 'merge' or 'unwrap'", |request, value| {
        request.evaluator.model.overlap = match value.as_str()? {
            "auto" => Overlap::Auto,
            "first" => Overlap::First,
            "merge" => Overlap::Merge,
            "unwrap" => Overlap::Unwrap,
            _ => return None,
        };
        Some(())
    }),
    option("padding", "0 to 8192 texels, or 'infinite'", |request, value| {
        request.padding = match value.as_str() {
            Some("infinite") => None,
            Some(_) => return None,
            None => Some(whole(value).filter(|texels| *texels <= 8192)?),
        };
        Some(())
    }),
    option("parts", "a list of parts of the model", |request, value| {
        request.evaluator.model.reading.parts.parts = texts(value)?;
        Some(())
    }),
    option("scale", "a number above 0", |request, value| {
        request.evaluator.model.scale = above_zero(value)? as f32;
        Some(())
    }),
    option("scene", "the number of a scene, from 0 on", |request, value| {
        request.evaluator.model.scene = Some(whole(value)?);
        Some(())
    }),
    option("seams", "'erase' or 'keep'", |request, value| {
        request.seams = match value.as_str()? {
            "erase" => Seams::Erase,
            "keep" => Seams::Keep,
            _ => return None,
        };
        Some(())
    }),
    option("smooth", "an angle in degrees, from 0 to 180", |request, value| {
        let degrees = value.as_f64()? as f32;
        request.evaluator.model.smooth_degrees = Some(is_smoothing_angle(degrees).then_some(degrees)?);
        Some(())
    }),
    option("turn_faces", "true or false", |request, value| {
        request.evaluator.model.reading.turn_faces = Some(value.as_bool()?);
        Some(())
    }),
    option("udim", "'auto', 'on' or 'off'", |request, value| {
        request.evaluator.model.udim = match value.as_str()? {
            "auto" => Udim::Auto,
            "on" => Udim::On,
            "off" => Udim::Off,
            _ => return None,
        };
        Some(())
    }),
    option("up", "'x', 'y' or 'z'", |request, value| {
        request.evaluator.model.up = match value.as_str()? {
            "x" => Up::X,
            "y" => Up::Y,
            "z" => Up::Z,
            _ => return None,
        };
        Some(())
    }),
    option("uv", "the number of a UV set, from 0 on", |request, value| {
        request.evaluator.model.uv = whole(value)?;
        Some(())
    }),
    option("with_model", "true or false", |request, value| {
        request.model = value.as_bool()?.then(CopyOptions::default);
        Some(())
    }),
    option("without", "a list of parts of the model", |request, value| {
        request.evaluator.model.reading.parts.without = texts(value)?;
        Some(())
    }),
];

/// Names of all options.
pub(crate) fn option_names() -> impl Iterator<Item = &'static str> {
    OPTIONS.iter().map(|option| option.name)
}

/// Checks a value for an option, without the graph and the model that it is for.
///
/// # Errors
/// A clause about an unknown name or a value that the option does not take.
pub(crate) fn check_option(name: &str, value: &Json) -> Result<(), String> {
    apply(&mut BakeRequest::plain(Path::new(""), Path::new(""), 16), name, value)
}

/// Options of a copy of the model.
const OF_COPIES: [&str; 2] = ["embed", "keep_look"];

/// Applies options to a request.
///
/// # Errors
/// As of [`check_option`], or an option of a copy of the model stands without a copy.
pub(crate) fn apply_options(request: &mut BakeRequest, options: &ItemOptions) -> Result<(), String> {
    // The copy of the model comes first, since other options apply to the copy.
    let is_copy = |name: &str| name == "with_model";
    let copy = options.iter().filter(|(name, _)| is_copy(name));
    let others = options.iter().filter(|(name, _)| !is_copy(name));
    for (name, value) in copy.chain(others) {
        apply(request, name, value)?;
    }
    let without_copy = OF_COPIES
        .iter()
        .find(|name| options.get(**name) == Some(&Json::Bool(true)) && request.model.is_none());
    match without_copy {
        Some(name) => Err(format!(
            "'{name}' is an option of a copy of the model; write with_model = true, too"
        )),
        None => Ok(()),
    }
}

fn apply(request: &mut BakeRequest, name: &str, value: &Json) -> Result<(), String> {
    let Some(option) = OPTIONS.iter().find(|option| option.name == name) else {
        let near = nearest(name, option_names());
        let advice = near.map_or_else(String::new, |near| format!("; did you mean '{near}'?"));
        return Err(format!("there is no option '{name}'{advice}"));
    };
    (option.apply)(request, value).ok_or_else(|| format!("'{name}' takes {}, not {value}", option.takes))
}

fn texts(value: &Json) -> Option<Vec<String>> {
    let names = value.as_array()?.iter().map(|name| name.as_str().map(str::to_owned));
    names.collect()
}

fn whole(value: &Json) -> Option<u32> {
    u32::try_from(value.as_u64()?).ok()
}

fn above_zero(value: &Json) -> Option<f64> {
    value
        .as_f64()
        .filter(|number| *number > 0.0 && (*number as f32).is_finite())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn an_option_accepts_the_values_in_its_description() {
        let good = [
            ("all_maps", json!(true)),
            ("channels", json!(["normal", "masks"])),
            ("fit", json!("metres")),
            ("fit", json!(0.25)),
            ("padding", json!("infinite")),
            ("padding", json!(8)),
            ("smooth", json!(40)),
            ("up", json!("z")),
        ];
        for (name, value) in good {
            assert_eq!(check_option(name, &value), Ok(()), "{name} {value}");
        }
        let bad = [
            ("all_maps", json!(1), "'all_maps' takes true or false, not 1"),
            (
                "channels",
                json!("normal"),
                "'channels' takes a list of channels, not \"normal\"",
            ),
            (
                "fit",
                json!(0),
                "'fit' takes 'unit', 'metres', 'piece' or a length above 0, not 0",
            ),
            (
                "padding",
                json!(-1),
                "'padding' takes 0 to 8192 texels, or 'infinite', not -1",
            ),
            (
                "smooth",
                json!(181),
                "'smooth' takes an angle in degrees, from 0 to 180, not 181",
            ),
            (
                "uv",
                json!(0.5),
                "'uv' takes the number of a UV set, from 0 on, not 0.5",
            ),
            (
                "paddin",
                json!(1),
                "there is no option 'paddin'; did you mean 'padding'?",
            ),
            ("adapter", json!("cpu"), "there is no option 'adapter'"),
        ];
        for (name, value, why) in bad {
            assert_eq!(check_option(name, &value), Err(why.to_owned()));
        }
    }

    #[test]
    fn the_look_is_kept_in_any_order_of_the_options() {
        let mut request = BakeRequest::plain(Path::new("a.sabi"), Path::new("a.glb"), 64);
        let options = json!({ "keep_look": true, "with_model": true });
        apply_options(&mut request, options.as_object().expect("an object")).expect("known options");
        assert!(request.model.is_some_and(|copy| copy.keeps_look));
        let alone = json!({ "embed": true, "with_model": false });
        let refused = apply_options(&mut request, alone.as_object().expect("an object"));
        let why = "'embed' is an option of a copy of the model; write with_model = true, too";
        assert_eq!(refused, Err(why.to_owned()));
    }
}
