//! Values as one writes them on a command line.

use sabi_graph::Value;

/// Reads `NAME=VALUE`. A value is a number, `true` or `false`, numbers separated by commas, a JSON list, or a word.
pub fn read_setting(text: &str) -> Result<(String, Value), String> {
    let (name, value) = text
        .split_once('=')
        .filter(|(name, _)| !name.trim().is_empty())
        .ok_or_else(|| format!("'{text}' is not of the form NAME=VALUE, as in amount=0.8 or paint.color=#6b3a1e"))?;
    Ok((name.trim().to_owned(), read_value(value.trim())))
}

fn read_value(text: &str) -> Value {
    match text {
        "true" | "on" => return Value::Bool(true),
        "false" | "off" => return Value::Bool(false),
        _ => {}
    }
    if let Some(number) = finite(text) {
        return Value::Number(number);
    }
    let parts: Option<Vec<f64>> = text.split(',').map(|part| finite(part.trim())).collect();
    if let Some(numbers) = parts {
        return Value::List(numbers.into_iter().map(Value::Number).collect());
    }
    if text.starts_with('[')
        && let Ok(json) = serde_json::from_str::<serde_json::Value>(text)
        && let Some(value) = from_json(&json)
    {
        return value;
    }
    Value::Text(text.to_owned())
}

fn finite(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|number| number.is_finite())
}

fn from_json(json: &serde_json::Value) -> Option<Value> {
    Some(match json {
        serde_json::Value::Bool(on) => Value::Bool(*on),
        serde_json::Value::Number(number) => Value::Number(number.as_f64()?),
        serde_json::Value::String(text) => Value::Text(text.clone()),
        serde_json::Value::Array(items) => Value::List(items.iter().map(from_json).collect::<Option<_>>()?),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use sabi_graph::Value;

    use super::read_setting;

    #[test]
    fn a_setting_is_read_as_what_it_looks_like() {
        let cases = [
            ("amount=0.8", "amount", Value::Number(0.8)),
            ("on=true", "on", Value::Bool(true)),
            ("paint.color=#6b3a1e", "paint.color", Value::Text("#6b3a1e".into())),
            (
                "toward=0,1,0",
                "toward",
                Value::List([0.0, 1.0, 0.0].map(Value::Number).to_vec()),
            ),
            ("mode=add", "mode", Value::Text("add".into())),
            ("name=a=b", "name", Value::Text("a=b".into())),
        ];
        for (text, name, value) in cases {
            assert_eq!(read_setting(text), Ok((name.to_owned(), value)), "{text}");
        }
        assert!(read_setting("amount").is_err() && read_setting("=1").is_err());
    }
}
