use std::ops::AddAssign;

/// Counts the work of a descent. `()` counts nothing and compiles to nothing.
pub trait Counters {
    /// The root spheres were compared.
    fn sphere_test(&mut self) {}
    /// `count` pairs of nodes were compared by their boxes.
    fn aabb_tests(&mut self, _count: u32) {}
    /// `count` pairs whose boxes met were compared by their k-DOPs.
    fn kdop_tests(&mut self, _count: u32) {}
    /// A pair of leaves was reached.
    fn leaf_pair(&mut self) {}
    /// `count` cells of a height field were read.
    fn cells(&mut self, _count: usize) {}
}

impl Counters for () {}

/// The work of one or more descents.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct DescentCounts {
    /// Pairs of root spheres compared.
    pub sphere_tests: u64,
    /// Pairs of nodes compared by their boxes.
    pub aabb_tests: u64,
    /// Pairs of nodes whose boxes met, compared by their k-DOPs.
    pub kdop_tests: u64,
    /// Pairs of leaves handed to the visitor.
    pub leaf_pairs: u64,
    /// Reads of cells of height fields.
    pub cells: u64,
}

impl Counters for DescentCounts {
    fn sphere_test(&mut self) {
        self.sphere_tests += 1;
    }

    fn aabb_tests(&mut self, count: u32) {
        self.aabb_tests += u64::from(count);
    }

    fn kdop_tests(&mut self, count: u32) {
        self.kdop_tests += u64::from(count);
    }

    fn leaf_pair(&mut self) {
        self.leaf_pairs += 1;
    }

    fn cells(&mut self, count: usize) {
        self.cells += count as u64;
    }
}

impl AddAssign for DescentCounts {
    fn add_assign(&mut self, other: Self) {
        let Self { sphere_tests, aabb_tests, kdop_tests, leaf_pairs, cells } = other;
        self.sphere_tests += sphere_tests;
        self.aabb_tests += aabb_tests;
        self.kdop_tests += kdop_tests;
        self.leaf_pairs += leaf_pairs;
        self.cells += cells;
    }
}

impl<C: Counters> Counters for &mut C {
    fn sphere_test(&mut self) {
        (**self).sphere_test();
    }

    fn aabb_tests(&mut self, count: u32) {
        (**self).aabb_tests(count);
    }

    fn kdop_tests(&mut self, count: u32) {
        (**self).kdop_tests(count);
    }

    fn leaf_pair(&mut self) {
        (**self).leaf_pair();
    }

    fn cells(&mut self, count: usize) {
        (**self).cells(count);
    }
}
