//! Lengths of a graph on the shown model.

use sabi_engine::live::LiveModel;

use super::expression::Units;
use super::values::text_of;

/// Units of lengths: lengths in a graph are working units, made from the model's units by the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LengthUnits {
    /// Factor from working units to units of the model's file.
    pub(crate) model_units_per_working: f64,
    /// Factor from units of the model's file to meters; 0 if unknown.
    pub(crate) metres_per_model_unit: f64,
}

/// Names of units, their length in meters, and the least length they are used for.
const UNITS: [(&str, f64, f64); 4] = [
    ("km", 1000.0, 1000.0),
    ("m", 1.0, 1.0),
    ("cm", 0.01, 0.01),
    ("mm", 0.001, 0.0),
];

impl LengthUnits {
    /// Units of lengths on a model; working units while there is none.
    pub(crate) fn on(model: Option<&LiveModel>) -> LengthUnits {
        LengthUnits {
            model_units_per_working: model.map_or(1.0, |model| model.fitted().model_from_working()),
            // glTF counts in meters.
            metres_per_model_unit: 1.0,
        }
    }

    /// A length in working units and on the model.
    pub(crate) fn in_both(&self, working: f64) -> String {
        let step = 10.0_f64.powf(working.abs().max(1e-9).log10().floor());
        let written = text_of(working, step);
        match self.text(working) {
            Some(real) => format!("{written} = {real}"),
            None => written,
        }
    }

    fn metres(&self) -> Option<f64> {
        let metres = self.model_units_per_working * self.metres_per_model_unit;
        (metres.is_normal() && metres > 0.0).then_some(metres)
    }

    /// A length on the model, such as `3.4 cm`; `None` where the size of the model is unknown.
    pub(super) fn text(&self, working: f64) -> Option<String> {
        let metres = working * self.metres()?;
        let (name, unit, _) = UNITS.iter().find(|(_, _, least)| metres.abs() >= *least)?;
        let number = metres / unit;
        // Three significant digits.
        let step = 10.0_f64.powf(number.abs().max(1e-9).log10().floor());
        Some(format!("{} {name}", text_of(number, step)))
    }

    /// Units that can follow a typed number, with their length in working units.
    pub(super) fn units(&self) -> [(&'static str, f64); 4] {
        // A meter is a unit of the file if the size of the model is unknown.
        let metres = self.metres().unwrap_or(1.0);
        UNITS.map(|(name, unit, _)| (name, unit / metres))
    }
}

/// Quantity of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Quantity {
    Plain,
    Degrees,
    Length(LengthUnits),
}

impl Quantity {
    /// Sign after each number.
    pub(super) fn sign(&self) -> &'static str {
        match self {
            Quantity::Degrees => "°",
            Quantity::Plain | Quantity::Length(_) => "",
        }
    }

    /// Number in another unit, for the tooltip.
    pub(super) fn note(&self, number: f64) -> Option<String> {
        match self {
            Quantity::Length(lengths) => lengths.text(number),
            Quantity::Plain | Quantity::Degrees => None,
        }
    }

    /// Reads a typed expression.
    pub(super) fn evaluate(&self, text: &str, present: Option<f64>) -> Result<f64, String> {
        let named;
        let units = match self {
            Quantity::Plain => Units::NONE,
            Quantity::Degrees => Units::DEGREES,
            Quantity::Length(lengths) => {
                named = lengths.units();
                Units {
                    named: &named,
                    ..Units::NONE
                }
            }
        };
        super::expression::evaluate(text, present, units)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_is_written_in_the_unit_that_suits_its_size() {
        let lengths = LengthUnits {
            model_units_per_working: 1.7,
            metres_per_model_unit: 1.0,
        };
        for (working, expected) in [
            (0.02, "3.4 cm"),
            (0.001, "1.7 mm"),
            (1.0, "1.7 m"),
            (1000.0, "1.7 km"),
            (0.0, "0 mm"),
            (-0.02, "-3.4 cm"),
            (0.0123456, "2.1 cm"),
        ] {
            assert_eq!(lengths.text(working).as_deref(), Some(expected), "{working}");
        }
        assert_eq!(lengths.in_both(0.0123456), "0.0123 = 2.1 cm");
    }

    #[test]
    fn a_length_has_no_unit_where_the_size_of_the_model_is_unknown() {
        for metres_per_model_unit in [0.0, f64::NAN, f64::INFINITY, -1.0] {
            let lengths = LengthUnits {
                model_units_per_working: 1.0,
                metres_per_model_unit,
            };
            assert_eq!(lengths.text(0.1), None);
            assert_eq!(lengths.in_both(0.1), "0.1");
            assert!(lengths.units().iter().all(|(_, factor)| factor.is_finite()));
        }
    }

    #[test]
    fn a_length_can_be_typed_as_it_is_on_the_model() {
        let lengths = LengthUnits {
            model_units_per_working: 2.0,
            metres_per_model_unit: 1.0,
        };
        assert_eq!(Quantity::Length(lengths).evaluate("10 cm", None), Ok(0.05));
    }
}
