//! Numbers over named axes, and how they are brought over those that a figure lies over.

use ndarray::{Array1, ArrayD, Axis, IxDyn};

use crate::store::dataset::Variable;

/// Numbers with the axes over which they lie.
pub struct Numbers<'n> {
    array: ArrayD<f64>,
    /// The axes, in the order of the array's dimensions.
    axes: Vec<&'n str>,
}

impl<'n> Numbers<'n> {
    /// Those of a variable; none where its array does not have its dimensions.
    pub fn of(variable: &'n Variable) -> Option<Numbers<'n>> {
        let array = variable.values.to_real();
        let axes: Vec<&str> = variable.dimensions.iter().map(String::as_str).collect();
        (array.ndim() == axes.len()).then_some(Numbers { array, axes })
    }

    /// The values of an axis.
    pub fn along(axis: &'n str, values: Vec<f64>) -> Numbers<'n> {
        Numbers { array: Array1::from(values).into_dyn(), axes: vec![axis] }
    }

    /// A number that no axis changes.
    pub fn constant(value: f64) -> Numbers<'n> {
        Numbers { array: ArrayD::from_elem(IxDyn(&[]), value), axes: Vec::new() }
    }

    /// Those at a place along one of the axes; none where it is shorter.
    pub fn held(mut self, axis: &str, place: usize) -> Option<Numbers<'n>> {
        let at = self.axes.iter().position(|it| *it == axis).unwrap_or(0);
        if place >= self.array.shape()[at] {
            return None;
        }
        self.axes.remove(at);
        Some(Numbers { array: self.array.index_axis_move(Axis(at), place), ..self })
    }

    /// The numbers over the axes `free`, in that order, and then over those that are left, repeated along what does not change
    /// them; none where the axes do not have these lengths.
    pub fn over(mut self, free: &[&'n str], lengths: &[usize]) -> Option<ArrayD<f64>> {
        for axis in free.iter().rev() {
            if !self.axes.contains(axis) {
                self.axes.insert(0, axis);
                self.array = self.array.insert_axis(Axis(0));
            }
        }
        let mut order: Vec<usize> =
            free.iter().filter_map(|axis| self.axes.iter().position(|it| it == axis)).collect();
        order.extend((0..self.axes.len()).filter(|at| !free.contains(&self.axes[*at])));
        let array = self.array.permuted_axes(IxDyn(&order));
        let mut shape: Vec<usize> = array.shape().to_vec();
        shape[..lengths.len()].copy_from_slice(lengths);
        array.broadcast(IxDyn(&shape)).map(|it| it.to_owned())
    }
}
