//! Delegation of trait methods to a field, for collectors that wrap another collector.

/// Implements trait methods by calling the method of the same name on the field `$field`.
///
/// The attributes before `fn` are given to every method. A receiver is written `self: &Self` or `self: &mut Self`.
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
