//! Fit in the form of a recipe: a word, or a length in meters.

use sabi_graph::Fit;
use schemars::JsonSchema;
use serde::de::{Deserialize, Deserializer, Error};
use serde::{Serialize, Serializer};

/// Length on the model that counts as 1.
#[derive(serde::Serialize, serde::Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum FitText {
    /// `unit` (the largest side), `metres` or `piece`.
    Word(String),
    /// Meters.
    Length(f64),
}

pub(super) fn serialize<S: Serializer>(fit: &Option<Fit>, serializer: S) -> Result<S::Ok, S::Error> {
    let written = fit.map(|fit| match fit {
        Fit::Unit => FitText::Word("unit".to_owned()),
        Fit::Metres => FitText::Word("metres".to_owned()),
        Fit::Piece => FitText::Word("piece".to_owned()),
        Fit::Length(meters) => FitText::Length(meters),
    });
    written.serialize(serializer)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Fit>, D::Error> {
    let written = Option::<FitText>::deserialize(deserializer)?;
    let fit = written.map(|written| match written {
        FitText::Word(word) => match word.as_str() {
            "unit" => Ok(Fit::Unit),
            "metres" => Ok(Fit::Metres),
            "piece" => Ok(Fit::Piece),
            _ => Err(D::Error::custom(format!("there is no fit '{word}'"))),
        },
        FitText::Length(meters) if meters.is_finite() && meters > 0.0 => Ok(Fit::Length(meters)),
        FitText::Length(meters) => Err(D::Error::custom(format!("a fit is a length above 0, not {meters}"))),
    });
    fit.transpose()
}
