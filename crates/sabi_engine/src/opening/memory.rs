//! Memory limits for a model and its pictures.

use std::fs;
use std::sync::OnceLock;

/// Memory of a model in bytes if that of the machine is not known.
const UNKNOWN: u64 = 8 << 30;
/// Minimum default memory of a model in bytes.
const LEAST: u64 = 1 << 30;

/// Returns the default memory limit for a model in bytes: half of the machine's memory, or half of the limit for the group
/// of this process.
pub fn default_memory_bytes() -> u64 {
    static BYTES: OnceLock<u64> = OnceLock::new();
    *BYTES.get_or_init(|| {
        // Only Linux reports it in files; other systems would need system calls.
        let machine = fs::read_to_string("/proc/meminfo")
            .ok()
            .and_then(|text| total_of(&text));
        let group = fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
        let group = group.and_then(|text| text.trim().parse().ok());
        share_of([machine, group].into_iter().flatten().min())
    })
}

/// Returns half of a machine's memory in bytes.
fn share_of(machine: Option<u64>) -> u64 {
    machine.map_or(UNKNOWN, |bytes| (bytes / 2).max(LEAST))
}

/// Total memory in the text of `/proc/meminfo`, bytes.
fn total_of(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::{LEAST, UNKNOWN, share_of, total_of};

    #[test]
    fn a_model_takes_half_of_the_memory() {
        let text = "MemTotal:       16384000 kB\nMemFree:         1000 kB\n";
        assert_eq!(total_of(text), Some(16_384_000 << 10));
        assert_eq!(total_of("MemFree: 1 kB\n"), None);
        assert_eq!(share_of(Some(16 << 30)), 8 << 30);
        assert_eq!(share_of(Some(1 << 20)), LEAST);
        assert_eq!(share_of(None), UNKNOWN);
    }
}
