//! Fair repeats.

/// Calls `measure` for each contestant in turn, `repeats` times over, so that a slow spell of the
/// machine meets all of them; the results by contestant.
///
/// Errors: the first that `measure` returns.
pub(super) fn in_turn<C, T, E>(
    contestants: &[C],
    repeats: usize,
    mut measure: impl FnMut(&C, usize) -> Result<T, E>,
) -> Result<Vec<Vec<T>>, E> {
    let mut results: Vec<Vec<T>> = contestants.iter().map(|_| Vec::new()).collect();
    for repeat in 0..repeats {
        for (contestant, results) in contestants.iter().zip(&mut results) {
            results.push(measure(contestant, repeat)?);
        }
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Would catch repeats in blocks, which a slow spell would turn into a difference.
    #[test]
    fn contestants_alternate() {
        let mut order = Vec::new();
        let results = in_turn(&["a", "b"], 2, |&name, repeat| {
            order.push((name, repeat));
            Ok::<_, ()>(order.len())
        });
        assert_eq!(order, [("a", 0), ("b", 0), ("a", 1), ("b", 1)]);
        assert_eq!(results, Ok(vec![vec![1, 3], vec![2, 4]]));
        let failing = in_turn(&[1, 2], 3, |&name, _| if name == 1 { Ok(()) } else { Err(name) });
        assert_eq!(failing, Err(2));
    }
}
