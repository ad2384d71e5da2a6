//! A program that is killed while it saves: its files are complete, and contain what it reported last or something later.

use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};

use super::*;

/// Environment variable with the folder of the program that is killed.
const FOLDER: &str = "SABI_TEST_OF_A_KILL";
/// Programs that are killed.
const KILLS: usize = 12;

/// Returns the number in the graph of a session: its gain, in thousandths.
fn number_of(session: &Session) -> u32 {
    match session
        .document()
        .graph
        .node("a")
        .and_then(|node| node.params.get("gain"))
    {
        Some(Value::Number(gain)) => (gain * 1000.0).round() as u32,
        _ => 0,
    }
}

/// Edits, stores in the recovery file and saves forever, and reports each once it is done.
fn save_for_ever(folder: &Path) {
    let mut session = Session::open(&folder.join("a.sabi"), Some(&folder.join("kept"))).unwrap();
    let mut out = std::io::stdout();
    for number in number_of(&session) + 1.. {
        session.edit("Gain", set_gain(number as f32 / 1000.0)).unwrap();
        session.keep(&[]).unwrap();
        writeln!(out, "\nkept {number}").unwrap();
        if number % 3 == 0 {
            session.save().unwrap();
            writeln!(out, "\nsaved {number}").unwrap();
        }
    }
}

/// Reads the program's reports until there are this many, kills it, and returns the last numbers that it stored and saved.
fn kill_after(lines: usize, folder: &Path) -> (u32, u32) {
    let mut program = Command::new(std::env::current_exe().unwrap());
    program.arg("session::tests::killed::a_killed_program_loses_nothing_that_it_told");
    program.args(["exact", "nocapture"].map(|option| format!("--{option}")));
    let mut child = program.env(FOLDER, folder).stdout(Stdio::piped()).spawn().unwrap();
    let told = BufReader::new(child.stdout.take().unwrap()).lines();
    let (mut kept, mut saved, mut count) = (0, 0, 0);
    for line in told {
        let line = line.unwrap();
        let number = |verb: &str| line.strip_prefix(verb)?.trim().parse::<u32>().ok();
        kept = number("kept").unwrap_or(kept);
        saved = number("saved").unwrap_or(saved);
        count += usize::from(number("kept").or(number("saved")).is_some());
        if count == lines {
            // Lines that the program writes between the last read and its end are read as well.
            child.kill().unwrap();
            count += 1;
        }
    }
    assert!(!child.wait().unwrap().success(), "it was killed");
    (kept, saved)
}

#[test]
fn a_killed_program_loses_nothing_that_it_told() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        return save_for_ever(Path::new(&folder));
    }
    let desk = desk();
    let (file, unsaved) = (desk.path().join("a.sabi"), desk.path().join("kept"));
    let mut session = Session::new(None);
    session.edit("Add", add("a")).unwrap();
    session.save_as(&file).unwrap();
    for kill in 0..KILLS {
        let (kept, saved) = kill_after(1 + kill * 3, desk.path());
        let found = number_of(&Session::open(&file, None).unwrap());
        assert!(found >= saved, "saved {saved}, found {found}");
        assert!(!is_open_in_a_window(&file));
        let mut recovered = recoveries(&unsaved);
        assert!(recovered.len() <= 1 && recovered.iter().all(|recovery| recovery.fault().is_none()));
        let newest = match recovered.pop() {
            Some(recovery) => {
                let session = Session::recover(recovery).unwrap();
                let newest = number_of(&session);
                session.close();
                newest
            }
            None => found,
        };
        assert!(
            newest >= kept && newest >= found,
            "kept {kept}, found {newest} and {found}"
        );
    }
}
