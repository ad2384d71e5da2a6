//! Explanations of naga's errors in the terms of node authors.

use crate::fault::{Fault, INVALID, Text};
use crate::scan::Scan;
use crate::shader_files::{CORE, Libraries};
use crate::words::nearest;

/// Starts of naga's messages about types, each with a message and advice for the author of a node.
const TYPES: [(&str, &str, &str); 9] = [
    (
        "The `return` expression",
        "What is returned here is not of the type that the function declares.",
        "Compare it with the type behind `->`.",
    ),
    (
        "The type of [",
        "What is assigned here is not of the variable's type.",
        "Convert it, for instance with `f32(…)` or `vec3f(…)`.",
    ),
    (
        "Operation ",
        "The two sides of this operation do not go together.",
        "Both sides need the same kind of number: write `2.0` beside f32, `2u` beside u32, or convert with `f32(…)`.",
    ),
    (
        "Argument ",
        "An argument of this call is not of the type that the function declares.",
        "Compare the arguments with the function's own, one by one.",
    ),
    (
        "Requires ",
        "This call has too few or too many arguments.",
        "Compare the arguments with the function's own, one by one.",
    ),
    (
        "The `if` condition",
        "The condition here is not true or false.",
        "Compare it with a value; for a toggle write `params.name != 0u`.",
    ),
    (
        "The `switch` value",
        "A `switch` chooses by a whole number.",
        "Convert it with `u32(…)`, or use `if`.",
    ),
    (
        "The `switch` contains cases",
        "The cases of this `switch` are numbers of another kind than its value.",
        "Write `case 1u` for a `u32`.",
    ),
    (
        "Multiple `switch` cases",
        "Two cases of this `switch` are the same.",
        "Remove one of them.",
    ),
];

/// Replaces naga's most frequent messages by explanations with advice.
pub(crate) fn explain(mut fault: Fault, scan: &Scan, text: Text<'_>, libraries: &Libraries, used: &[String]) -> Fault {
    if let Some(word) = quoted(&fault.message, "Name `", "` is a reserved keyword") {
        fault.message = format!("`{word}` is a reserved word of WGSL.");
        fault.advice = format!("Choose another name, such as `{word}_value`.");
    } else if let Some(name) = quoted(&fault.message, "No definition in scope for identifier: `", "`") {
        fault.advice = unknown_name_advice(&name, scan, text, libraries, used);
        fault.message = format!("Nothing is called `{name}` here.");
    } else if let Some(name) = quoted(&fault.message, "Redefinition of `", "`") {
        fault.message = format!("`{name}` is defined twice.");
        fault.advice = "Rename one of the two; libraries and `Surface` and `Material` count too.".to_owned();
    } else if let Some(name) = quoted(&fault.message, "Invalid field accessor `", "`") {
        let near = nearest(&name, members(scan, text, libraries));
        fault.message = format!("There is no member `{name}` here.");
        fault.advice = near.map_or(String::new(), |meant| format!("Did you mean `{meant}`?"));
    } else if let Some(name) = quoted(&fault.message, "Declaration of `", "` is ") {
        fault.message = format!("`{name}` is defined by itself.");
        fault.advice =
            "A function cannot call itself, not even by way of another one; use a loop with a constant bound."
                .to_owned();
    } else if let Some(found) = fault.message.strip_prefix(INVALID)
        && let Some((_, message, advice)) = TYPES.iter().find(|(start, ..)| found.starts_with(start))
    {
        fault.message = (*message).to_owned();
        fault.advice = (*advice).to_owned();
    }
    fault
}

fn quoted(message: &str, before: &str, after: &str) -> Option<String> {
    let rest = message.strip_prefix(before)?;
    rest.split_once(after).map(|(word, _)| word.to_owned())
}

/// Returns advice for an unknown name: a library that declares it, a parameter with that name, or a similar known name.
fn unknown_name_advice(name: &str, scan: &Scan, text: Text<'_>, libraries: &Libraries, used: &[String]) -> String {
    let declares = |text: &str, name: &str| {
        ["fn ", "const ", "struct ", "alias "].iter().any(|keyword| {
            text.lines().any(|line| {
                line.strip_prefix(keyword)
                    .and_then(|rest| rest.strip_prefix(name))
                    .is_some_and(|rest| !rest.starts_with(|c: char| c == '_' || c.is_alphanumeric()))
            })
        })
    };
    let library = libraries.names().find(|library| {
        !used.iter().any(|used| used == library) && libraries.text(library).is_some_and(|text| declares(text, name))
    });
    if let Some(library) = library {
        return format!("It is in lib/{library}.wgsl: add `//! @use {library}` to the header.");
    }
    if scan
        .params()
        .is_some_and(|params| params.members.iter().any(|member| member.name == name))
    {
        return format!("The parameter is written `params.{name}`.");
    }
    let linked = std::iter::once(CORE)
        .chain(used.iter().map(String::as_str))
        .filter_map(|library| libraries.text(library));
    let mut known: Vec<&str> = Vec::new();
    for text in linked.chain([text.text]) {
        for keyword in ["fn ", "const ", "let ", "var ", "struct "] {
            known.extend(text.split(keyword).skip(1).map(|rest| {
                let end = rest.find(|c: char| c != '_' && !c.is_alphanumeric());
                &rest[..end.unwrap_or(rest.len())]
            }));
        }
    }
    known.retain(|known| *known != name && !known.is_empty());
    match nearest(name, known) {
        Some(meant) => format!("Did you mean `{meant}`?"),
        None => "Define it, or add the library that has it with `//! @use name` to the header.".to_owned(),
    }
}

/// Lists names of members: of the parameters, and of the structs that `core` declares.
fn members<'a>(scan: &'a Scan, text: Text<'a>, libraries: &'a Libraries) -> Vec<&'a str> {
    let own = scan.items.iter().flat_map(|item| item.members.iter());
    let mut names: Vec<&str> = own
        .filter_map(|member| text.text.get(member.name_range.clone()))
        .collect();
    // If `core` is missing, its members cannot be suggested.
    for line in libraries.text(CORE).into_iter().flat_map(str::lines) {
        if let Some((name, _)) = line.trim().split_once(": ")
            && crate::names::is_plain_name(name)
        {
            names.push(name);
        }
    }
    names
}
