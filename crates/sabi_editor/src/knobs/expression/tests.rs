use super::*;

fn plain(text: &str) -> Result<f64, String> {
    evaluate(text, Some(0.5), Units::NONE)
}

#[test]
fn expressions_have_the_results_of_mathematics() {
    for (text, expected) in [
        ("2*0.3", 0.6),
        ("1/3", 1.0 / 3.0),
        ("1+2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("2-3-4", -5.0),
        ("8/4/2", 1.0),
        ("7%4", 3.0),
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("--3", 3.0),
        ("2*-3", -6.0),
        (" 1.5e-2 ", 0.015),
        (".5", 0.5),
        ("3.", 3.0),
        ("=4", 4.0),
        ("−1", -1.0),
        ("sqrt(2)^2", 2.0),
        ("min(3, 1, 2)+max(1, 4)", 5.0),
        ("pow(2, 10)", 1024.0),
        ("floor(1.7)+ceil(1.2)+round(2.5)+abs(-1)", 7.0),
        ("sin(pi/2)+cos(0)+tan(0)", 2.0),
        ("tau/pi", 2.0),
        ("2*e/e", 2.0),
    ] {
        let found = plain(text).unwrap();
        assert!((found - expected).abs() < 1e-12, "{text} is {found}");
    }
}

#[test]
fn an_expression_can_start_from_the_present_number() {
    for (text, expected) in [("+=0.1", 0.6), ("-= 1/4", 0.25), ("*=2", 1.0), ("/=2", 0.25)] {
        assert_eq!(plain(text), Ok(expected), "{text}");
    }
    let told = evaluate("*=2", None, Units::NONE).unwrap_err();
    assert!(told.contains("differ"), "{told}");
}

#[test]
fn knobs_of_angles_measure_in_degrees() {
    let degrees = |text: &str| evaluate(text, None, Units::DEGREES).unwrap();
    assert!((degrees("sin(30)") - 0.5).abs() < 1e-12);
    assert_eq!(degrees("45°"), 45.0);
    assert!((degrees("pi/4 rad") - 45.0).abs() < 1e-12);
}

#[test]
fn a_unit_behind_a_number_is_brought_to_that_of_the_knob() {
    let units = Units {
        named: &[("cm", 0.01), ("m", 1.0)],
        angle: 1.0,
    };
    let found = evaluate("2 m + 3.4cm", None, units).unwrap();
    assert!((found - 2.034).abs() < 1e-12);
    assert_eq!(evaluate("1/2 cm", None, units), Ok(0.005));
    assert_eq!(evaluate("2 cm*3", None, units), Ok(0.06));
    let told = evaluate("2 ft", None, units).unwrap_err();
    assert_eq!(told, "`ft` is none of the units cm, m (character 3).");
}

#[test]
fn an_error_names_the_character_that_it_is_at() {
    for (text, expected) in [
        ("", "A number is missing (character 1)."),
        ("1 +", "A number is missing (character 4)."),
        ("(1+2", "This `(` is not closed (character 1)."),
        ("1)", "This `)` closes nothing (character 2)."),
        ("0,5", "Decimals are written with a point, as in 0.5 (character 2)."),
        ("1.2.3", "`1.2.3` is not a number (character 1)."),
        ("2 * $", "`$` stands where a number is missing (character 5)."),
        ("3 cm", "`cm` cannot stand here: this number has no unit (character 3)."),
        ("sqrt(1, 2)", "`sqrt` takes one number (character 1)."),
        ("+=*2", "`*` stands where a number is missing (character 3)."),
    ] {
        assert_eq!(plain(text), Err(expected.to_owned()), "{text}");
    }
    assert!(plain("1/0").unwrap_err().starts_with("This has no finite result"));
    assert!(plain("sqrt(-1)").unwrap_err().starts_with("This has no finite result"));
    assert!(plain("sine(1)").unwrap_err().starts_with("`sine` is not known here"));
}

#[test]
fn no_depth_of_an_expression_overflows_the_stack() {
    for text in [
        "(".repeat(100_000),
        "-".repeat(100_000),
        "1^".repeat(100_000),
        "sin(".repeat(100_000),
    ] {
        assert!(plain(&text).unwrap_err().contains("No more than 64"));
    }
}
