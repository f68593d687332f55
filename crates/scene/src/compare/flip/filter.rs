//! [`Plane`]: a channel of a picture, and filters that are applied along its rows and its columns.
//!
//! *In:* a number for each pixel, and kernels with an odd number of weights. *Out:* planes of the same size.
//!
//! *Holds:* beyond the border is the nearest pixel. Any size is taken, also an empty one, and one smaller than the kernel.

/// A number for each pixel, top row first, x fastest.
pub(super) struct Plane {
    width: usize,
    /// The numbers.
    pub(super) values: Vec<f32>,
}

impl Plane {
    /// A plane of rows with a width.
    pub(super) fn new(width: usize, values: Vec<f32>) -> Self {
        Self { width: width.max(1), values }
    }

    /// A function of each number.
    pub(super) fn map(&self, function: impl Fn(f32) -> f32) -> Self {
        Self::new(self.width, self.values.iter().map(|value| function(*value)).collect())
    }

    /// The sum of two planes.
    pub(super) fn plus(mut self, other: &Self) -> Self {
        add_scaled(&mut self.values, &other.values, 1.0);
        self
    }

    /// The filter whose kernel is the product of one along the rows and one along the columns.
    pub(super) fn filtered(&self, across: &[f32], down: &[f32]) -> Self {
        self.across(across).down(down)
    }

    /// The filter along the rows: a weighted sum of the row, moved by each number of pixels.
    pub(super) fn across(&self, kernel: &[f32]) -> Self {
        let mut values = vec![0.0; self.values.len()];
        for (sum, row) in values.chunks_exact_mut(self.width).zip(self.values.chunks_exact(self.width)) {
            let padded = padded(row, kernel.len() / 2);
            add_weighted(sum, kernel, padded.windows(row.len()));
        }
        Self::new(self.width, values)
    }

    /// The filter along the columns: a weighted sum of rows.
    pub(super) fn down(&self, kernel: &[f32]) -> Self {
        let mut values = vec![0.0; self.values.len()];
        let rows: Vec<&[f32]> = self.values.chunks_exact(self.width).collect();
        let padded = padded(&rows, kernel.len() / 2);
        for (sum, rows) in values.chunks_exact_mut(self.width).zip(padded.windows(kernel.len())) {
            add_weighted(sum, kernel, rows.iter().copied());
        }
        Self::new(self.width, values)
    }
}

/// The items, with the first and the last of them repeated `radius` times.
fn padded<T: Copy>(items: &[T], radius: usize) -> Vec<T> {
    let repeated = |item: Option<&T>| item.copied().into_iter().cycle().take(radius);
    repeated(items.first()).chain(items.iter().copied()).chain(repeated(items.last())).collect()
}

/// Adds rows, each times its weight.
fn add_weighted<'a>(sum: &mut [f32], weights: &[f32], rows: impl Iterator<Item = &'a [f32]>) {
    weights.iter().zip(rows).for_each(|(weight, row)| add_scaled(sum, row, *weight));
}

fn add_scaled(sum: &mut [f32], row: &[f32], weight: f32) {
    sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNEL: [f32; 3] = [1.0, 10.0, 100.0];

    #[test]
    fn the_border_is_repeated() {
        let plane = Plane::new(3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(plane.across(&KERNEL).values, [211.0, 321.0, 332.0, 544.0, 654.0, 665.0]);
        assert_eq!(plane.down(&KERNEL).values, [411.0, 522.0, 633.0, 441.0, 552.0, 663.0]);
        assert_eq!(plane.filtered(&KERNEL, &[1.0]).values, plane.across(&KERNEL).values);
    }

    #[test]
    fn planes_may_be_smaller_than_kernels_and_empty() {
        let weights = [1.0; 21];
        assert_eq!(Plane::new(1, vec![2.0]).filtered(&weights, &weights).values, [882.0]);
        assert!(Plane::new(0, Vec::new()).filtered(&weights, &weights).values.is_empty());
    }
}
