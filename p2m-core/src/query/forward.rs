//! Macros for collectors that wrap another collector: delegation of trait methods to a field.

/// Implements trait methods by delegation to the methods of the same name on the field `$field`.
///
/// The attributes before `fn` apply to every method. A receiver is written `self: &Self` or `self: &mut Self`.
macro_rules! forward_methods {
    (@each $field:ident, $attributes:tt, ) => {};
    (@each $field:ident, [$(#[$attribute:meta])*],
        fn $name:ident($this:ident: $receiver:ty $(, $argument:ident: $type:ty)*) $(-> $result:ty)?; $($rest:tt)*
    ) => {
        $(#[$attribute])*
        fn $name($this: $receiver $(, $argument: $type)*) $(-> $result)? {
            $this.$field.$name($($argument),*)
        }
        forward_methods!(@each $field, [$(#[$attribute])*], $($rest)*);
    };
    ($field:ident, [$(#[$attribute:meta])*], { $($methods:tt)* }) => {
        forward_methods!(@each $field, [$(#[$attribute])*], $($methods)*);
    };
}

/// Implements the methods of [`Collector`](crate::Collector) that return decisions, but not the methods by which a
/// search reports.
macro_rules! forward_collector_decisions {
    ($field:ident, $attributes:tt) => {
        forward_methods!($field, $attributes, {
            fn prune_above(self: &Self) -> f64;
            fn prune_given_upper_bound(self: &Self, square: f64) -> f64;
            fn prune_given_incumbent(self: &Self, square: f64) -> f64;
            fn prune_above_for_id(self: &Self, id: $crate::PrimitiveId) -> f64;
            fn is_single_nearest(self: &Self) -> bool;
            fn keeps_near_ties(self: &Self) -> bool;
            fn near_tie_slack(self: &Self) -> f64;
            fn is_approximate(self: &Self) -> bool;
            fn may_stop(self: &Self, has_incumbent: bool) -> bool;
            fn record_skipped(self: &mut Self, square: f64);
        });
    };
}
