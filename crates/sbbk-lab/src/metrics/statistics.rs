//! The few numbers that stand for many.

use serde::Serialize;

/// Least, middle, mean and greatest of some values. Times are reported by minimum, which other work
/// of the machine disturbs least, and by median.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    pub count: usize,
    pub min: f64,
    /// The middle one, or the mean of the middle two.
    pub median: f64,
    /// All but a hundredth are no greater.
    pub p99: f64,
    pub mean: f64,
    pub max: f64,
}

impl Summary {
    /// Sums up `values`, of which NaN is the largest; `None` without values.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let count = sorted.len();
        let (&min, &max) = (sorted.first()?, sorted.last()?);
        Some(Self {
            count,
            min,
            median: 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]),
            p99: sorted[(0.99 * count as f64).ceil() as usize - 1],
            mean: sorted.iter().sum::<f64>() / count as f64,
            max,
        })
    }
}

/// Geometric mean; `None` without values. A value that is not positive makes it 0 or NaN.
pub fn geometric_mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let logarithms = Summary::of(values.into_iter().map(f64::ln))?;
    Some(logarithms.mean.exp())
}

/// At most `limit` of some items, evenly spread.
pub fn sample<T>(items: &[T], limit: usize) -> impl ExactSizeIterator<Item = &T> {
    let (count, sample_count) = (items.len(), items.len().min(limit));
    (0..sample_count).map(move |i| &items[i * count / sample_count])
}

/// Would catch a median or percentile off by one place.
#[test]
fn numbers_are_summed_up() {
    let odd = Summary::of([9.0, 1.0, 4.0]).unwrap();
    assert_eq!((odd.min, odd.median, odd.max, odd.p99), (1.0, 4.0, 9.0, 9.0));
    let even = Summary::of([9.0, 1.0, 4.0, 2.0]).unwrap();
    assert_eq!((even.count, even.median, even.mean), (4, 3.0, 4.0));
    assert_eq!(Summary::of((1..=200).map(f64::from)).unwrap().p99, 198.0);
    assert!((geometric_mean([2.0, 0.5]).unwrap() - 1.0).abs() < 1e-12);
}
