//! Errors name a place in the file and advise what to do.

use crate::Document;

/// Returns the error for a file with these lines as its body; `nodes` starts on line 2.
fn error_of(body: &str) -> String {
    let text = format!("{{ \"format\": \"sabi\", \"version\": 1,\n{body} }}");
    Document::from_json(&text)
        .unwrap_err()
        .with_name("rust.sabi")
        .to_string()
}

fn check(cases: &[(&str, &str)]) {
    for (body, text) in cases {
        assert_eq!(error_of(body), format!("rust.sabi:{text}"), "{body}");
    }
}

#[test]
fn an_impossible_link_is_reported_with_its_node_and_input() {
    check(&[
        (
            "\"nodes\": { \"worn_p2dd\": { \"kind\": \"blend/mask\" },\n  \"rust\": { \"kind\": \"effect/layer\",\n    \
             \"inputs\": { \"mask\": \"wron_p2dd.mask\" } } }",
            "4:25: node \"rust\", input \"mask\": there is no node \"wron_p2dd\" (did you mean \"worn_p2dd\"?)",
        ),
        (
            "\"nodes\": { \"a\": { \"kind\": \"x\", \"inputs\": { \"base\": \"a\" } } }",
            "2:52: node \"a\", input \"base\": node \"a\" cannot read its own result; connect another node",
        ),
        (
            "\"nodes\": { \"a\": { \"kind\": \"x\", \"inputs\": { \"in\": \"c\" } },\n\"b\": { \"kind\": \"x\", \"inputs\": \
             { \"in\": \"a\" } },\n\"c\": { \"kind\": \"x\", \"inputs\": { \"in\": \"b\", \"other\": \"a\" } } }",
            "2:50: node \"a\", input \"in\": the nodes feed each other in a circle: a → c → a; remove one of these links",
        ),
        (
            "\"nodes\": { \"a\": { \"kind\": \"x\", \"inputs\": { \"base\": \"B.out\" } } }",
            "2:52: node \"a\", input \"base\": \"B\" cannot be a node's id; use 1 to 64 of the characters a-z, 0-9 and _",
        ),
        (
            "\"nodes\": { \"a\": { \"kind\": \"x\", \"inputs\": { \"base\": 7 } } }",
            "2:52: node \"a\", input \"base\": \"base\" must be a text in quotes, not the number 7",
        ),
    ]);
}

#[test]
fn an_error_in_a_group_names_the_group_and_the_node() {
    check(&[(
        "\"groups\": { \"grain\": { \"nodes\": { \"n\": { \"params\": {} } } } },\n\"nodes\": {}",
        "2:40: group \"grain\", node \"n\": the node has no kind; give it one, as in \"kind\": \"noise/simplex\"",
    )]);
}

#[test]
fn an_exposed_knob_or_port_must_exist() {
    let nodes = "\"nodes\": { \"edges\": { \"kind\": \"x\" } }";
    for (more, text) in [
        (
            "\"exposed\": { \"amount\": { \"to\": [\"edgse.width\"] } }",
            "2:33: there is no node \"edgse\" (did you mean \"edges\"?)",
        ),
        (
            "\"exposed\": { \"amount\": { \"to\": [\"edges\"] } }",
            "2:33: \"edges\" names no parameter or input; write the node's id, a dot and the name, as in \
             \"edges.width\"",
        ),
        (
            "\"exposed\": { \"a.b\": { \"to\": [] } }",
            "2:14: \"a.b\" cannot be the name of a knob; use 1 to 200 characters, without dots and equal signs",
        ),
        (
            "\"exposed\": { \"amount\": { \"to\": [] } },\n\"variants\": { \"heavy\": { \"amuont\": 1 } }",
            "3:26: variant \"heavy\" sets \"amuont\", which is not exposed (did you mean \"amount\"?)",
        ),
        (
            "\"inputs\": { \"a\": { \"to\": [\"edges.x\"] }, \"b\": { \"to\": [\"edges.x\"] } }",
            "2:41: group inputs \"a\" and \"b\" both feed edges.x; let only one of them do so",
        ),
        (
            "\"inputs\": { \"a\": { \"to\": [], \"type\": \"colour\" } }",
            "2:38: \"type\" must be \"mask\", \"color\", \"vector\" or \"material\", not the text \"colour\"",
        ),
        (
            "\"outputs\": { \"mask\": \"edge\" }",
            "2:22: there is no node \"edge\" (did you mean \"edges\"?)",
        ),
        (
            "\"fit\": \"meter\"",
            "2:8: \"fit\" must be \"unit\", \"metres\", \"piece\", or the length above zero that counts as 1, not the \
             text \"meter\"",
        ),
        (
            "\"seed\": -1",
            "2:9: \"seed\" must be a whole number from 0 to 4294967295, not the number -1",
        ),
    ] {
        check(&[(&format!("{more},\n{nodes}"), text)]);
    }
    check(&[(
        "\"name\": \"x\"",
        "1:1: \"nodes\" is missing; a graph has \"nodes\": {}, even when there are none",
    )]);
}

#[test]
fn an_instance_must_name_an_existing_group() {
    check(&[
        (
            "\"groups\": { \"grain\": { \"nodes\": {} } },\n\"nodes\": { \"i\": { \"kind\": \"graph/group\", \"group\": \
             \"gran\" } }",
            "3:51: node \"i\": there is no group \"gran\" (did you mean \"grain\"?); define it under \"groups\", or \
             name a .sabi file",
        ),
        (
            "\"nodes\": { \"i\": { \"kind\": \"graph/group\" } }",
            "2:27: node \"i\": the node is a group instance but names no group; add \"group\": \"name or file.sabi\"",
        ),
    ]);
}

#[test]
fn a_syntax_error_in_json_is_reported_with_its_place() {
    for (text, message) in [
        (
            "",
            "line 1, column 1: the file ends where a value is expected; it may have been cut off",
        ),
        (
            "{\n  \"a\": 1,\n}",
            "line 3, column 1: a key in quotes is expected here, not '}'",
        ),
        (
            "{\"ä\": 01}",
            "line 1, column 7: \"01\" is not how JSON writes a number",
        ),
        (
            "{\"a\": 1e39}",
            "line 1, column 7: the number \"1e39\" is too large; numbers go up to 3.4e38",
        ),
        (
            "{\"a\": NaN}",
            "line 1, column 7: \"NaN\" is no JSON value; texts stand in quotes",
        ),
        (
            "{\"a\": 1, \"a\": 2}",
            "line 1, column 10: the key \"a\" stands here a second time; keep one of them",
        ),
        (
            "{\"a\": \"b",
            "line 1, column 7: the file ends inside the text that begins here; it may have been cut off",
        ),
        (
            "[\"\\ud800x\"]",
            "line 1, column 3: this escape is not one JSON knows; a backslash itself is written \\\\",
        ),
        (
            "[1] 2",
            "line 1, column 5: the file goes on after its closing brace; remove what follows",
        ),
        (
            "[\"a\tb\"]",
            "line 1, column 4: a text may not hold a line break or control character; write it as \\n or \\u00xx",
        ),
        (
            "[1]",
            "line 1, column 1: this is not a Sabi graph: it must be an object that begins with \"format\": \"sabi\"",
        ),
    ] {
        assert_eq!(Document::from_json(text).unwrap_err().to_string(), message);
    }
}

#[test]
fn the_format_version_of_a_file_is_the_version_it_was_written_in() {
    for version in [0, 1] {
        let text = format!("{{ \"format\": \"sabi\", \"version\": {version}, \"nodes\": {{}} }}");
        assert_eq!(crate::format_version(&text), Ok(version));
    }
    assert!(crate::format_version("{ \"format\": \"sabi\", \"version\": 2 }").is_err());
}

#[test]
fn a_newer_file_is_refused_by_its_version() {
    let error = |version: &str| {
        let text = format!("{{\n\"format\": \"sabi\",\n\"version\": {version}, \"nodes\": 5 }}");
        Document::from_json(&text).unwrap_err().to_string()
    };
    assert_eq!(
        error("3"),
        "line 3, column 12: written by a newer Sabi (version 3; this one reads up to 1); open it with that one, or \
         install it here"
    );
    assert_eq!(
        error("\"1\""),
        "line 3, column 12: \"version\" must be a whole number from 0 to 1, not the text \"1\""
    );
}

#[test]
fn a_hostile_file_gives_an_error_message_and_no_crash() {
    let deep = "[".repeat(1_000_000);
    let message = "line 1, column 130: values are nested more than 128 deep here; flatten them";
    assert_eq!(Document::from_json(&deep).unwrap_err().to_string(), message);
    let many = format!("[{}0]", "0,".repeat(4_000_000));
    let message = Document::from_json(&many).unwrap_err().to_string();
    assert!(
        message.contains("larger than 64 MiB or has more than 4 million values"),
        "{message}"
    );
    let deep_value = format!("\"nodes\": {{}}, \"x\": {}1{}", "[".repeat(70), "]".repeat(70));
    let message = error_of(&deep_value);
    assert!(message.contains("the value of \"x\" cannot be kept"), "{message}");
}

#[test]
fn an_error_in_an_old_file_is_reported_at_its_place_in_that_file() {
    let text = "{ \"format\": \"sabi\", \"version\": 0,\n\"nodes\": { \"a\": { \"kind\": \"x\" } },\n\"edges\": [\n{ \
                \"from\": \"b\", \"to\": \"a.in\" }] }";
    let message = "line 4, column 11: node \"a\", input \"in\": there is no node \"b\"";
    assert_eq!(Document::from_json(text).unwrap_err().to_string(), message);
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_loads() {
    let mut nodes = String::from("\"n0\": { \"kind\": \"x\" }");
    for place in 1..100_000 {
        nodes.push_str(&format!(
            ",\"n{place}\": {{ \"kind\": \"x\", \"inputs\": {{ \"in\": \"n{}\" }} }}",
            place - 1
        ));
    }
    let document = super::document("", &nodes);
    let order = document.graph.topological_order();
    assert_eq!(order.len(), 100_000);
    assert_eq!(order[99_999].as_str(), "n99999");
}

#[test]
fn a_curve_belongs_to_a_parameter_that_its_knob_sets_and_needs_a_default() {
    let nodes = "\"nodes\": { \"edges\": { \"kind\": \"x\" } }";
    for (more, text) in [
        (
            "\"exposed\": { \"age\": { \"to\": [\"edges.width\"], \"default\": 0,\n\"curves\": { \"edges.width\": [[0, 1]] } } }",
            "3:28: the curve of edges.width cannot be used; write at least two points [knob value, parameter value] whose knob \
             values grow",
        ),
        (
            "\"exposed\": { \"age\": { \"to\": [], \"default\": 0, \"curves\": { \"edges.width\": [[0, 1], [1, 2]] } } }",
            "2:21: knob \"age\" has a curve for edges.width, which it does not set; add it to \"to\", or take the curve out",
        ),
        (
            "\"exposed\": { \"age\": { \"to\": [\"edges.width\"], \"curves\": { \"edges.width\": [[0, 1], [1, 2]] } } }",
            "2:21: knob \"age\" has curves and no default; write the number that it stands at as \"default\"",
        ),
    ] {
        check(&[(&format!("{more},\n{nodes}"), text)]);
    }
}
