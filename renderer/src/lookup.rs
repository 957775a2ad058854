//! The cell of a number among nodes, without a search.

/// Increasing nodes, and the cell of a number among them without a search: buckets uniform in the root of
/// the share of the whole range, since nodes lie closest at its beginning.
#[derive(Debug, Clone)]
pub(crate) struct Lookup {
    nodes: Vec<f64>,
    first: Vec<u32>,
    scale: f64,
}

impl Lookup {
    /// At least two increasing nodes.
    pub(crate) fn new(nodes: Vec<f64>) -> Self {
        let buckets = 4 * nodes.len();
        let scale = 1.0 / (nodes[nodes.len() - 1] - nodes[0]);
        let mut first = vec![0; buckets + 1];
        let mut cell = 0_u32;
        for (bucket, first) in first.iter_mut().enumerate() {
            let root = bucket as f64 / buckets as f64;
            // Rounding of the root below cannot pass this node.
            let from = nodes[0] + root * root * (1.0 - 1e-12) / scale;
            while (cell as usize) + 2 < nodes.len() && nodes[cell as usize + 1] < from {
                cell += 1;
            }
            *first = cell;
        }
        Self { nodes, first, scale }
    }

    /// The nodes.
    pub(crate) fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    pub(crate) fn last(&self) -> f64 {
        self.nodes[self.nodes.len() - 1]
    }

    /// The cell i with nodes[i] <= x < nodes[i + 1]; the first or the last cell for what lies outside.
    #[inline(always)]
    pub(crate) fn cell(&self, x: f64) -> usize {
        let share = ((x - self.nodes[0]) * self.scale).clamp(0.0, 1.0);
        let bucket = (share.sqrt() * (self.first.len() - 1) as f64) as usize;
        let mut cell = self.first[bucket] as usize;
        while cell + 2 < self.nodes.len() && self.nodes[cell + 1] <= x {
            cell += 1;
        }
        cell
    }

    /// The cell of `x` and the fraction of it below `x`, 0 to 1.
    #[inline(always)]
    pub(crate) fn locate(&self, x: f64) -> (usize, f64) {
        let cell = self.cell(x);
        let (a, b) = (self.nodes[cell], self.nodes[cell + 1]);
        (cell, ((x - a) / (b - a)).clamp(0.0, 1.0))
    }
}
