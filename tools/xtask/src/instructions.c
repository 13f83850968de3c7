// A plugin of qemu that counts the instructions of the program that qemu runs. Each time the program asks for the number
// of its process, the plugin writes the count. It uses version 1 of the interface for plugins, which qemu has since 4.2.
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct block;
size_t qemu_plugin_tb_n_insns(const struct block *block);
void qemu_plugin_register_vcpu_tb_trans_cb(uint64_t plugin, void (*translated)(uint64_t, struct block *));
void qemu_plugin_register_vcpu_tb_exec_inline(struct block *block, int operation, void *counter, uint64_t summand);
void qemu_plugin_register_vcpu_syscall_cb(uint64_t plugin,
                                          void (*called)(uint64_t, unsigned, int64_t, uint64_t, uint64_t, uint64_t,
                                                         uint64_t, uint64_t, uint64_t, uint64_t, uint64_t));

int qemu_plugin_version = 1;

enum { ADD = 0, GETPID = 172 };

static uint64_t count;

static void on_translation(uint64_t plugin, struct block *block) {
    qemu_plugin_register_vcpu_tb_exec_inline(block, ADD, &count, qemu_plugin_tb_n_insns(block));
}

static void on_call(uint64_t plugin, unsigned processor, int64_t number, uint64_t a, uint64_t b, uint64_t c, uint64_t d,
                    uint64_t e, uint64_t f, uint64_t g, uint64_t h) {
    if (number == GETPID) {
        fprintf(stderr, "count %llu\n", (unsigned long long)count);
    }
}

int qemu_plugin_install(uint64_t plugin, const void *info, int argc, char **argv) {
    qemu_plugin_register_vcpu_tb_trans_cb(plugin, on_translation);
    qemu_plugin_register_vcpu_syscall_cb(plugin, on_call);
    return 0;
}
