//! What does not fit together in a description.

use std::collections::BTreeSet;

use super::{Description, MOST_COORDINATES, Source, SpectrumRoles};

impl Description {
    /// What does not fit together in it, each in a sentence, where a point of its section has so many coordinates; nothing where all
    /// does.
    pub fn faults(&'static self, dimension: usize) -> Vec<String> {
        let mut faults = self.faults_of_coordinates(dimension);
        faults.extend(self.faults_of_names());
        faults.extend(self.faults_of_roles());
        faults.extend(self.faults_of_signals());
        faults
    }

    fn faults_of_coordinates(&self, dimension: usize) -> Vec<String> {
        let mut faults = Vec::new();
        if !(1..=MOST_COORDINATES).contains(&dimension) {
            let most = MOST_COORDINATES;
            faults.push(format!("a section point has 1 to {most} coordinates, not {dimension}"));
        }
        for (what, count) in [
            ("on_section", self.on_section.len()),
            ("section", self.section.len()),
            ("compared_as", self.compared_as.len()),
            ("neutral", self.neutral.len()),
            ("edge", self.edge.len()),
            ("end", self.end.len()),
        ] {
            if count != dimension {
                faults.push(format!(
                    "{what} has {count} entries, and a section point has {dimension} coordinates"
                ));
            }
        }
        if let Some(SpectrumRoles { exponents, .. }) = self.roles.spectrum
            && exponents.len() != dimension
        {
            faults.push(format!(
                "the spectrum has {} exponents, and a section point has {dimension} coordinates",
                exponents.len()
            ));
        }
        let places = self.on_section.iter().map(|place| ("on_section", *place));
        let places = places.chain(self.drift.map(|place| ("drift", place)));
        for (what, place) in places.filter(|it| it.1 >= self.coordinates.len()) {
            let count = self.coordinates.len();
            faults.push(format!("{what} names coordinate {place} of {count}, counted from 0"));
        }
        if self.drift.is_some_and(|drift| self.on_section.contains(&drift)) {
            faults.push("the coordinate that drifts is no coordinate of section points".to_owned());
        }
        faults
    }

    /// The names of all quantities that it describes.
    pub fn names(&self) -> Vec<&'static str> {
        let motion = &self.motion;
        let derived = motion.signals.iter().filter(|it| !matches!(it.source, Source::Kept(_)));
        let quantities = self.parameters.iter().map(|it| it.quantity);
        let quantities = quantities.chain(self.outputs.iter().map(|it| it.quantity));
        let quantities = quantities.chain(self.coordinates.iter().map(|it| it.start));
        let lists =
            [self.section, self.neutral, self.edge, self.end, motion.impact, motion.histories];
        let quantities = quantities.chain(lists.into_iter().flatten().copied());
        let quantities = quantities.chain(derived.map(|it| it.quantity));
        let quantities = quantities.chain(motion.groups.iter().map(|it| it.quantity));
        quantities.map(|it| it.name).collect()
    }

    /// Names that stand for two things.
    fn faults_of_names(&self) -> Vec<String> {
        let (mut seen, mut twice) = (BTreeSet::new(), BTreeSet::new());
        for name in self.names() {
            if !seen.insert(name) {
                twice.insert(name);
            }
        }
        twice.into_iter().map(|name| format!("two quantities are called {name}")).collect()
    }

    fn faults_of_roles(&self) -> Vec<String> {
        let roles = &self.roles;
        let drive =
            roles.drive.iter().flat_map(|it| [it.frequency, it.amplitude, it.period]).flatten();
        let parameters = drive
            .chain(roles.impact_surface)
            .chain(roles.rear_surface)
            .chain(roles.natural.into_iter().flatten());
        let trade_off = roles.trade_off.iter().flat_map(|it| {
            [it.speed, it.work, it.power, it.energy_per_distance]
                .into_iter()
                .chain(it.costs.iter().copied())
        });
        let outputs = [
            roles.exponent,
            roles.exponent_error,
            roles.excluded_period,
            roles.defect,
            roles.section_residual,
        ];
        let of_spectrum = roles.spectrum.iter().flat_map(SpectrumRoles::all);
        let outputs = outputs.into_iter().chain(of_spectrum).chain(roles.gain_error);
        let outputs = outputs.chain(roles.rest_share).chain(trade_off);
        let lists = [roles.key_outputs, roles.event_counts, roles.impact_counts];
        let outputs = outputs.chain(lists.into_iter().flatten().copied());
        let of_parameters =
            parameters.filter_map(|it| fault_of_role("parameter", it, self.parameters.len()));
        let of_outputs = outputs.filter_map(|it| fault_of_role("output", it, self.outputs.len()));
        of_parameters.chain(of_outputs).collect()
    }

    fn faults_of_signals(&'static self) -> Vec<String> {
        let motion = &self.motion;
        let mut faults = Vec::new();
        let (kept, coordinates) = (motion.histories.len(), self.coordinates.len());
        if kept > 0 && kept < coordinates {
            faults.push(format!("histories begin with the {coordinates} coordinates of a state, and there are {kept}"));
        }
        for signal in motion.signals {
            match signal.source {
                Source::Kept(place) if place >= kept => {
                    faults.push(format!(
                        "the signal {} is history {place} of {kept}, counted from 0",
                        signal.name()
                    ));
                }
                Source::State(_) | Source::Parameters(_) if kept == 0 => {
                    faults.push(format!(
                        "the signal {} follows from histories, and there are none",
                        signal.name()
                    ));
                }
                _ => {}
            }
        }
        let of_groups = motion.groups.iter().flat_map(|it| it.signals);
        let of_charts = motion.charts.iter().flat_map(|it| it.signals);
        let alone =
            of_groups.chain(of_charts).copied().chain(motion.portrait.into_iter().flatten());
        let unknown = alone.filter(|name| self.signal(name).is_none());
        let panels = motion.panels.iter().copied();
        let panels =
            panels.filter(|it| self.signal(it).is_none() && self.signal_group(it).is_none());
        faults
            .extend(unknown.chain(panels).map(|name| format!("there is no signal called {name}")));
        faults
    }
}

/// What is wrong with the place that a role names among so many.
fn fault_of_role(what: &str, place: usize, count: usize) -> Option<String> {
    (place >= count).then(|| format!("a role names {what} {place} of {count}, counted from 0"))
}
