//! Where a figure holds the axes over which it does not lie, and the panels along those that it holds at several values.

/// Panels along one axis that stand side by side at most.
const COLUMNS: usize = 4;

/// The axes that are held, with the places of values along them.
#[derive(Debug, Clone, Default)]
pub struct Held {
    /// The place at which each axis is held, the first where it is held at several.
    pub places: Vec<(String, usize)>,
    /// The places along each axis that is held at several values.
    pub panelled: Vec<(String, Vec<usize>)>,
}

impl Held {
    /// Holds an axis at a place.
    pub fn hold(&mut self, axis: &str, place: usize) {
        self.places.push((axis.to_owned(), place));
    }

    /// Holds an axis at several places, each with panels of its own.
    pub fn hold_at_each(&mut self, axis: &str, places: Vec<usize>) {
        self.places.extend(places.first().map(|first| (axis.to_owned(), *first)));
        self.panelled.push((axis.to_owned(), places));
    }

    /// The place at which an axis is held; the first of an axis that is not.
    pub fn place(&self, axis: &str) -> usize {
        self.places.iter().find(|(name, _)| name == axis).map_or(0, |(_, place)| *place)
    }

    /// Whether an axis is held.
    pub fn has(&self, axis: &str) -> bool {
        self.places.iter().any(|(name, _)| name == axis)
    }

    /// The same with an axis held at another place, for a single panel.
    pub fn moved(&self, axis: &str, place: usize) -> Held {
        self.panel(vec![(axis.to_owned(), place)])
    }

    /// Where each panel holds the axes, row by row: those along the first axis that is held at several values, those along the
    /// second side by side.
    pub fn panels(&self) -> Vec<Vec<Held>> {
        let columns = self.along(1);
        let mut rows: Vec<Vec<Held>> = Vec::new();
        for row in self.along(0) {
            let of_row = columns.iter().map(|column| [&row[..], column].concat());
            rows.push(of_row.map(|places| self.panel(places)).collect());
        }
        if self.panelled.len() != 1 {
            return rows;
        }
        // The panels along one axis are read like lines of text.
        let panels: Vec<Held> = rows.into_iter().flatten().collect();
        panels.chunks(COLUMNS).map(<[Held]>::to_vec).collect()
    }

    /// The axis of this number among those that are held at several values, with each of its places; nothing, once, where there
    /// is none.
    fn along(&self, number: usize) -> Vec<Vec<(String, usize)>> {
        match self.panelled.get(number) {
            Some((axis, places)) => places.iter().map(|at| vec![(axis.clone(), *at)]).collect(),
            None => vec![Vec::new()],
        }
    }

    /// Where a panel holds the axes: some at `own` places, the others as here.
    fn panel(&self, own: Vec<(String, usize)>) -> Held {
        let others = self.places.iter().filter(|(name, _)| own.iter().all(|it| it.0 != *name));
        let mut places: Vec<(String, usize)> = others.cloned().collect();
        places.extend(own);
        Held { places, panelled: Vec::new() }
    }
}
