//! The facts of the machine that a report states.
//!
//! *Holds:* what the system does not tell is `None`; nothing is guessed.

use glisten_report::Machine;

/// The CPU, its threads and its load.
pub(crate) fn machine() -> Machine {
    Machine {
        cpu: cpu(&read("/proc/cpuinfo")),
        threads: std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        load: load(&read("/proc/loadavg")),
    }
}

fn read(path: &str) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

/// The name of the first CPU in Linux's list.
fn cpu(list: &str) -> Option<String> {
    let line = list.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned()).filter(|name| !name.is_empty())
}

/// The mean of a minute.
fn load(text: &str) -> Option<f64> {
    text.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::{cpu, load};

    #[test]
    fn what_linux_tells_is_read() {
        let list =
            "processor\t: 0\nvendor_id\t: X\nmodel name\t: AMD EPYC 7B13\n\nprocessor\t: 1\nmodel name\t: other\n";
        assert_eq!(cpu(list).as_deref(), Some("AMD EPYC 7B13"));
        assert_eq!((cpu(""), cpu("model name\t:\n")), (None, None));
        assert_eq!((load("0.52 0.58 0.59 1/389 1234\n"), load("")), (Some(0.52), None));
    }
}
