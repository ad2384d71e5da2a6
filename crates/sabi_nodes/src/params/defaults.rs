//! Reads `@default` of a parameter.

use super::ParamReader;
use crate::annotations::{Annotation, number};
use crate::color::color_linear;
use crate::curve::curve_points;
use crate::kind::{Memory, ParamValue, Role, UNUSED_STOP};
use crate::words::{list, nearest};

impl ParamReader<'_> {
    /// Reads `@absolute`.
    pub(super) fn is_absolute(&mut self, role: &Role) -> Option<bool> {
        let Some(annotation) = self.comment.get("absolute").cloned() else {
            return Some(false);
        };
        if *role != Role::Length || !annotation.words.is_empty() {
            let message = "`@absolute` stands by itself beside `@length`.";
            let advice =
                "Write `@length @absolute`: a share of the model, also where lengths are shares of each piece.";
            self.at_annotation(&annotation, message, advice);
            return None;
        }
        Some(true)
    }

    /// Reads the default. Seeds and extents of the model need no default.
    pub(super) fn default(&mut self, memory: Memory, role: &Role) -> Option<ParamValue> {
        let Some(annotation) = self.comment.get("default").cloned() else {
            match role {
                Role::Seed => return Some(ParamValue::Unsigned(0)),
                Role::Extent { high, .. } => return Some(ParamValue::Floats(vec![f32::from(*high)])),
                _ => {}
            }
            let message = format!("The parameter `{}` has no default.", self.member.name);
            self.at_name(message, "Write `@default` with the value it starts with.");
            return None;
        };
        match (role, memory) {
            (Role::Toggle, _) => self.toggle(&annotation),
            (Role::Choice(words), _) => self.choice(&annotation, words),
            (Role::Color, _) => self.color(&annotation),
            (Role::Stops, Memory::Points(count)) => self.stops(&annotation, count as usize),
            (Role::Curve, Memory::Points(count)) => self.curve(&annotation, count as usize),
            (_, Memory::U32) => self.whole(&annotation, "0", ParamValue::Unsigned),
            (_, Memory::I32) => self.whole(&annotation, "0", ParamValue::Signed),
            _ => self.floats(&annotation, memory.components()),
        }
    }

    fn toggle(&mut self, annotation: &Annotation) -> Option<ParamValue> {
        match annotation.joined().as_str() {
            "on" | "true" | "1" => Some(ParamValue::Unsigned(1)),
            "off" | "false" | "0" => Some(ParamValue::Unsigned(0)),
            _ => {
                self.at_annotation(
                    annotation,
                    "The default of a toggle is `on` or `off`.",
                    "Write `@default on`.",
                );
                None
            }
        }
    }

    fn choice(&mut self, annotation: &Annotation, words: &[String]) -> Option<ParamValue> {
        let written = annotation.joined();
        if let Some(index) = words.iter().position(|word| *word == written) {
            return Some(ParamValue::Unsigned(index as u32));
        }
        let all = words.iter().map(String::as_str);
        let advice = match nearest(&written, all.clone()) {
            Some(meant) => format!("Did you mean `{meant}`? The choices are {}.", list(all)),
            None => format!("The choices are {}.", list(all)),
        };
        self.at_annotation(
            annotation,
            format!("The default `{written}` is not one of the choices."),
            advice,
        );
        None
    }

    fn color(&mut self, annotation: &Annotation) -> Option<ParamValue> {
        let color = color_linear(&annotation.joined());
        if color.is_none() {
            self.at_annotation(
                annotation,
                "The default of a color is `#rrggbb`.",
                "Write `@default #808080`.",
            );
        }
        color.map(|color| ParamValue::Floats(color.to_vec()))
    }

    /// Reads pairs of `position #rrggbb`, with ascending positions in 0..1.
    fn stops(&mut self, annotation: &Annotation, count: usize) -> Option<ParamValue> {
        let mut values = Vec::with_capacity(4 * count);
        let mut last = 0.0;
        let pairs = annotation.words.chunks(2);
        let mut good = pairs.len() >= 1 && pairs.len() <= count;
        for pair in pairs {
            let stop = match pair {
                [position, color] => number(position).zip(color_linear(&color.text)),
                _ => None,
            };
            match stop.filter(|(position, _)| (last..=1.0).contains(position)) {
                Some((position, color)) => {
                    last = position;
                    values.extend(color);
                    values.push(position);
                }
                None => good = false,
            }
        }
        if !good {
            self.at_annotation(
                annotation,
                format!("The default of a gradient is 1 to {count} stops: positions from 0 to 1, each with a color."),
                "Write `@default 0 #000000 1 #ffffff`.",
            );
            return None;
        }
        while values.len() < 4 * count {
            values.extend([0.0, 0.0, 0.0, UNUSED_STOP]);
        }
        Some(ParamValue::Floats(values))
    }

    /// Reads pairs of `x y`, with ascending x.
    fn curve(&mut self, annotation: &Annotation, count: usize) -> Option<ParamValue> {
        let numbers: Option<Vec<f32>> = annotation.words.iter().map(number).collect();
        let Some(points) = numbers.as_deref().and_then(|numbers| ascending_points(numbers, count)) else {
            self.at_annotation(
                annotation,
                format!("The default of a curve is 1 to {count} points: pairs of numbers, x and y, with x growing."),
                "Write `@default 0 0 1 1`.",
            );
            return None;
        };
        Some(ParamValue::Floats(curve_points(points, count)))
    }

    fn whole<T: std::str::FromStr>(
        &mut self,
        annotation: &Annotation,
        example: &str,
        value: fn(T) -> ParamValue,
    ) -> Option<ParamValue> {
        let parsed = annotation.joined().parse::<T>().ok();
        if parsed.is_none() {
            let message = "The default of this type is a whole number.";
            self.at_annotation(annotation, message, format!("Write `@default {example}`."));
        }
        parsed.map(value)
    }

    fn floats(&mut self, annotation: &Annotation, count: usize) -> Option<ParamValue> {
        let values: Option<Vec<f32>> = annotation.words.iter().map(number).collect();
        let values = values.filter(|values| values.len() == count);
        if values.is_none() {
            let zeros = vec!["0"; count].join(" ");
            let numbers = match count {
                1 => "one number".to_owned(),
                _ => format!("{count} numbers"),
            };
            let message = format!("The default of this type is {numbers}.");
            self.at_annotation(annotation, message, format!("Write `@default {zeros}`."));
        }
        values.map(ParamValue::Floats)
    }
}

/// Returns the numbers as 1 to `most` points with ascending x; `None` if they are not such points.
fn ascending_points(numbers: &[f32], most: usize) -> Option<&[[f32; 2]]> {
    let (points, rest) = numbers.as_chunks::<2>();
    let is_sorted = points.is_sorted_by(|left, right| left[0] <= right[0]);
    (rest.is_empty() && is_sorted && (1..=most).contains(&points.len())).then_some(points)
}
