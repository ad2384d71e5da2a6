//! Keys and the commands that are bound to them.

use std::collections::BTreeMap;

use egui::{Event, Key, Modifiers};

use crate::command::{Command, InputPreset, Scope};

/// Key with the modifiers held down; `Ctrl` is Command on a Mac.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chord {
    pub(crate) modifiers: Modifiers,
    pub(crate) key: Key,
}

impl Chord {
    /// Reads `Ctrl+Shift+D`.
    pub(crate) fn parse(text: &str) -> Result<Chord, String> {
        let mut modifiers = Modifiers::NONE;
        // The key itself may be a plus.
        let (held, key) = match text.strip_suffix("++") {
            Some(held) => (held, "+"),
            None => text.rsplit_once('+').unwrap_or(("", text)),
        };
        for word in held.split('+').filter(|word| !word.is_empty()) {
            match word.trim() {
                "Ctrl" => modifiers.command = true,
                "Shift" => modifiers.shift = true,
                "Alt" => modifiers.alt = true,
                other => return Err(format!("'{other}' is no key to hold; there are Ctrl, Shift and Alt")),
            }
        }
        let key = Key::from_name(key.trim()).ok_or_else(|| format!("there is no key '{}'", key.trim()))?;
        Ok(Chord { modifiers, key })
    }

    /// Text that [`Chord::parse`] reads.
    pub(crate) fn text(self) -> String {
        let held = [
            (self.modifiers.command || self.modifiers.ctrl, "Ctrl+"),
            (self.modifiers.shift, "Shift+"),
            (self.modifiers.alt, "Alt+"),
        ];
        let held: String = held
            .iter()
            .filter(|(is_held, _)| *is_held)
            .map(|(_, word)| *word)
            .collect();
        format!("{held}{}", sign_of(self.key))
    }

    /// Returns whether a pressed key with these modifiers matches this chord.
    pub(crate) fn is(self, modifiers: Modifiers, key: Key) -> bool {
        let held = |modifiers: Modifiers| [modifiers.command || modifiers.ctrl, modifiers.shift, modifiers.alt];
        key == self.key && held(modifiers) == held(self.modifiers)
    }
}

/// Name of a key: the sign that is printed on keyboards, if it is a single one, which [`Key::from_name`] reads as well.
/// The plus keeps its name, since its sign separates keys.
fn sign_of(key: Key) -> &'static str {
    if key == Key::Minus {
        // Its symbol is the minus of formulas, which no keyboard has.
        return "-";
    }
    let sign = key.symbol_or_name();
    let is_printed = sign.len() == 1 && sign != "+" && Key::from_name(sign) == Some(key);
    if is_printed { sign } else { key.name() }
}

/// Returns the chord behind a clipboard event. Systems report the usual keys of copy, cut and paste only as these
/// events, without any further modifiers that are held.
pub(crate) fn from_clipboard_event(event: &Event) -> Option<Chord> {
    let key = match event {
        Event::Copy => Key::C,
        Event::Cut => Key::X,
        Event::Paste(_) => Key::V,
        _ => return None,
    };
    Some(Chord {
        modifiers: Modifiers::COMMAND,
        key,
    })
}

/// Commands of the keys.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KeyMap {
    bound: Vec<(Chord, Command)>,
}

impl KeyMap {
    /// Keys of a preset, with the keys of settings in place of those of some commands, by name. Also returns a sentence for
    /// each key that cannot be read.
    pub(crate) fn new(preset: InputPreset, own: &BTreeMap<String, Vec<String>>) -> (KeyMap, Vec<String>) {
        let mut faults = Vec::new();
        let mut bound = Vec::new();
        for command in Command::ALL {
            let texts: Vec<&str> = match own.get(command.name()) {
                Some(texts) => texts.iter().map(String::as_str).collect(),
                None => command.keys(preset).to_vec(),
            };
            for text in texts {
                match Chord::parse(text) {
                    Ok(chord) => bound.push((chord, *command)),
                    Err(why) => faults.push(format!("the key for \"{}\" is left out: {why}", command.title())),
                }
            }
        }
        (KeyMap { bound }, faults)
    }

    /// Command that a key is bound to in a scope.
    pub(crate) fn command(&self, scope: Scope, modifiers: Modifiers, key: Key) -> Option<Command> {
        let meant = self.bound.iter().filter(|(chord, _)| chord.is(modifiers, key));
        let mut meant = meant.map(|(_, command)| *command);
        meant.find(|command| command.scope() == scope || command.scope() == Scope::Window)
    }

    /// Keys that are bound to a command.
    pub(crate) fn chords(&self, command: Command) -> impl Iterator<Item = Chord> {
        self.bound
            .iter()
            .filter(move |(_, bound)| *bound == command)
            .map(|(chord, _)| *chord)
    }

    /// First key of a command as text; empty where it has none.
    pub(crate) fn shown(&self, command: Command) -> String {
        self.chords(command).next().map_or_else(String::new, Chord::text)
    }

    /// Pairs of commands that the same key is bound to in the same scope, of which only the first is ever performed.
    pub(crate) fn clashes(&self) -> Vec<(Chord, [Command; 2])> {
        let mut clashes = Vec::new();
        for (at, (chord, one)) in self.bound.iter().enumerate() {
            for (other_chord, other) in &self.bound[at + 1..] {
                let meets = one.scope() == other.scope() || [one, other].iter().any(|it| it.scope() == Scope::Window);
                if chord == other_chord && one != other && meets {
                    clashes.push((*chord, [*one, *other]));
                }
            }
        }
        clashes
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::command::{Favorite, GraphCommand};

    #[test]
    fn every_preset_can_be_read_and_no_key_means_two_things_in_one_place() {
        for (preset, name) in InputPreset::ALL {
            let (keys, faults) = KeyMap::new(preset, &BTreeMap::new());
            assert_eq!(faults, Vec::<String>::new(), "{name}");
            assert_eq!(keys.clashes(), [], "{name}");
        }
    }

    #[test]
    fn all_commands_have_different_names() {
        let names: BTreeSet<&str> = Command::ALL.iter().map(|command| command.name()).collect();
        assert_eq!(names.len(), Command::ALL.len());
    }

    #[test]
    fn nine_favorites_have_a_key_each_in_every_preset() {
        for (preset, name) in InputPreset::ALL {
            let (keys, _) = KeyMap::new(preset, &BTreeMap::new());
            for &favorite in Favorite::ALL {
                let number = (favorite.index() + 1).to_string();
                assert_eq!(keys.shown(Command::Favorite(favorite)), number, "{name}");
            }
        }
    }

    #[test]
    fn a_chord_is_written_as_it_is_read() {
        for text in ["Ctrl+Shift+D", "Tab", "Alt+X", "F6", "Ctrl+=", "Period", "CloseBracket"] {
            let chord = Chord::parse(text).expect("a chord");
            assert_eq!(Chord::parse(&chord.text()), Ok(chord), "{text}");
        }
        for (name, sign) in [
            ("CloseBracket", "]"),
            ("Period", "."),
            ("Shift+Comma", "Shift+,"),
            ("Tab", "Tab"),
        ] {
            assert_eq!(Chord::parse(name).expect("a chord").text(), sign);
        }
        assert_eq!(
            Chord::parse("Hyper+D"),
            Err("'Hyper' is no key to hold; there are Ctrl, Shift and Alt".to_owned())
        );
        assert_eq!(Chord::parse("Ctrl+Any"), Err("there is no key 'Any'".to_owned()));
    }

    #[test]
    fn settings_bind_a_command_to_another_key() {
        let own = BTreeMap::from([("mute".to_owned(), vec!["I".to_owned()])]);
        let (keys, _) = KeyMap::new(InputPreset::Default, &own);
        assert_eq!(
            keys.command(Scope::Canvas, Modifiers::NONE, Key::I),
            Some(Command::Graph(GraphCommand::Mute))
        );
        assert_eq!(keys.command(Scope::Canvas, Modifiers::NONE, Key::M), None);
        assert_eq!(keys.command(Scope::Viewport, Modifiers::NONE, Key::I), None);
    }
}
