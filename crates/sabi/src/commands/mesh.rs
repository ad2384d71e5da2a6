//! `sabi mesh`: a model and its atlas.

use sabi_engine::{LinkedModel, describe_mesh};
use serde_json::Value as Json;

use crate::arguments::MeshArguments;
use crate::exit::{Exit, Failure};
use crate::progress::Bars;
use crate::terminal::{Terminal, plain};

pub(crate) fn run(arguments: MeshArguments, terminal: &Terminal) -> Result<Exit, Failure> {
    let options = arguments.model.options(arguments.mesh, arguments.maps.size);
    let bars = Bars::new(terminal);
    let linked = LinkedModel::open(&options, &bars)?;
    drop(bars);
    let description = describe_mesh(&linked);
    for warning in linked.warnings() {
        terminal.warning(warning);
    }
    if arguments.json {
        terminal.json(&description)?;
    } else {
        terminal.data(&table(&description))?;
    }
    Ok(Exit::Done)
}

/// One fact a line; warnings were told already.
fn table(description: &Json) -> String {
    let facts = description.as_object().into_iter().flatten();
    facts
        .filter(|(name, _)| *name != "warnings")
        .map(|(name, value)| format!("{:24} {}\n", name.replace('_', " "), plain(value)))
        .collect()
}
