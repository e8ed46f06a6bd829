"""The forms from outside by name."""

from blockshake.diagnosis.outside import (
    blow,
    changed_edge,
    following,
    free_force,
    loose_weight,
    push,
    spring_once,
)

FORMS = {
    form.name: form
    for form in (
        push.FORM,
        blow.FORM,
        *following.FORMS,
        spring_once.FORM,
        changed_edge.FORM,
        loose_weight.FORM,
        free_force.FORM,
    )
}
