//! A few configurations that have every pair of values of every two macros.
//!
//! *In:* how many values each macro has. *Out:* for each configuration the number of each macro's value. *Holds:* the first
//! configuration has the first values; the same input gives the same configurations.

use std::collections::BTreeSet;

/// A value of a macro: the numbers of both.
type Value = (usize, usize);

/// At most `most` configurations that together have as many pairs of values as possible.
pub(super) fn pairs(sizes: &[usize], most: usize) -> Vec<Vec<usize>> {
    let mut open: BTreeSet<(Value, Value)> = BTreeSet::new();
    for (a, &size_a) in sizes.iter().enumerate() {
        for (b, &size_b) in sizes.iter().enumerate().skip(a + 1) {
            open.extend((0..size_a).flat_map(|i| (0..size_b).map(move |j| ((a, i), (b, j)))));
        }
    }
    let mut all = vec![vec![0; sizes.len()]];
    if let ([size], true) = (sizes, open.is_empty()) {
        all.extend((1..*size).map(|value| vec![value]));
    }
    while let Some(last) = all.last() {
        close(&mut open, last);
        if all.len() >= most {
            break;
        }
        let Some(&first) = open.iter().next() else { break };
        all.push(grown(sizes, first, &open));
    }
    all.truncate(most);
    all
}

fn close(open: &mut BTreeSet<(Value, Value)>, configuration: &[usize]) {
    for (a, &i) in configuration.iter().enumerate() {
        for (b, &j) in configuration.iter().enumerate().skip(a + 1) {
            open.remove(&((a, i), (b, j)));
        }
    }
}

/// A configuration with a pair, whose other values are chosen one after the other for the most open pairs.
fn grown(sizes: &[usize], first: (Value, Value), open: &BTreeSet<(Value, Value)>) -> Vec<usize> {
    let mut chosen: Vec<Option<usize>> = vec![None; sizes.len()];
    for (of, value) in [first.0, first.1] {
        if let Some(slot) = chosen.get_mut(of) {
            *slot = Some(value);
        }
    }
    for (of, &size) in sizes.iter().enumerate() {
        if chosen.get(of).copied().flatten().is_some() {
            continue;
        }
        let gain = |value: usize| {
            let others = chosen.iter().enumerate().filter_map(|(other, chosen)| Some((other, (*chosen)?)));
            let pair = |other: Value| if other.0 < of { (other, (of, value)) } else { ((of, value), other) };
            others.filter(|other| open.contains(&pair(*other))).count()
        };
        // Of equals the first: the fewer macros are defined, the better the message.
        let best = (0..size).max_by_key(|&value| (gain(value), size - value)).unwrap_or(0);
        if let Some(slot) = chosen.get_mut(of) {
            *slot = Some(best);
        }
    }
    chosen.into_iter().map(Option::unwrap_or_default).collect()
}

#[cfg(test)]
mod tests {
    use super::pairs;

    #[test]
    fn all_pairs_are_there_in_few_configurations() {
        for sizes in [&[2, 2][..], &[2; 12], &[3, 2, 4, 2, 2], &[8, 8]] {
            let all = pairs(sizes, 100);
            for (a, &size_a) in sizes.iter().enumerate() {
                for (b, &size_b) in sizes.iter().enumerate().skip(a + 1) {
                    for i in 0..size_a {
                        for j in 0..size_b {
                            assert!(all.iter().any(|one| one[a] == i && one[b] == j), "{sizes:?}: {a} {i} {b} {j}");
                        }
                    }
                }
            }
            assert!(all.first().is_some_and(|first| first.iter().all(|value| *value == 0)));
        }
        assert!(pairs(&[2; 12], 100).len() <= 12, "{}", pairs(&[2; 12], 100).len());
        assert_eq!(pairs(&[3], 100), [[0], [1], [2]]);
        assert_eq!(pairs(&[], 100), [[0; 0]]);
        assert_eq!(pairs(&[8, 8], 5).len(), 5);
    }
}
