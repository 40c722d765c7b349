# Sourced by the scripts beside it.

# Says a command, then runs it.
step() {
    echo "+ $*"
    "$@"
}

# The same, but shows what the command prints only if it fails.
quiet_step() {
    echo "+ $*"
    quiet_log=$(mktemp)
    quiet_status=0
    "$@" >"$quiet_log" 2>&1 || quiet_status=$?
    if [ $quiet_status != 0 ]; then
        tail -n 40 "$quiet_log" >&2
        echo "$0: the command above failed" >&2
    fi
    rm -f "$quiet_log"
    return $quiet_status
}
