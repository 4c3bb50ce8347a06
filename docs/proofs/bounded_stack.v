(* The surface stack stays within its bound: the machine-checked form of stack.md.

   Coq 8.16, no axioms: `coqc bounded_stack.v`. Numbers of lemmas and theorems are those of stack.md.
   A stack is the list of its levels, top first; the length of what is behind an entry is its index.
   Roots that wait are entries of level 0 at the bottom of BOUNDED's list, and a number w in the rest. *)
Require Import List Arith Lia Permutation.
Import ListNotations.

Section Stack.
Variables p k : nat. (* the batch and the number of levels *)
Hypothesis Hp : 1 <= p.
Hypothesis Hk : 1 <= k.

(* ---- The model ---- *)

(* What an adversary makes of a batch: it removes a surface or, below the last level, splits it. *)
Inductive expand : list nat -> list nat -> Prop :=
| expand_nil : expand [] []
| expand_drop : forall l b b', expand b b' -> expand (l :: b) b'
| expand_split : forall l b b', S l < k -> expand b b' -> expand (l :: b) (S l :: S l :: b').

(* All that may be split is split. *)
Definition split_all (b : list nat) := flat_map (fun l => if S l <? k then [S l; S l] else []) b.

(* BOUNDED: the batch is the top p surfaces, or all there are. *)
Inductive step : list nat -> list nat -> Prop :=
| step_batch : forall b r b', length b = Nat.min p (length (b ++ r)) ->
    expand b b' -> step (b ++ r) (b' ++ r).

Inductive run (s0 : list nat) : nat -> list nat -> Prop :=
| run_0 : run s0 0 s0
| run_S : forall t s s', run s0 t s -> step s s' -> run s0 (S t) s'.

(* m_d of stack.md: what n surfaces can become in d iterations. *)
Fixpoint most (n d : nat) : nat :=
  match d with 0 => n | S d' => most n d' + Nat.min p (most n d') end.

(* Surfaces of level i and deeper, and of level i and shallower. *)
Fixpoint deep (i : nat) (s : list nat) : nat :=
  match s with [] => 0 | l :: t => (if i <=? l then 1 else 0) + deep i t end.
Definition shallow i s := length s - deep (S i) s.

(* The deepest are on top. *)
Fixpoint sorted (s : list nat) : Prop :=
  match s with [] => True | l :: t => Forall (fun x => x <= l) t /\ sorted t end.

(* ---- Counting ---- *)

Lemma deep_app i a b : deep i (a ++ b) = deep i a + deep i b.
Proof. induction a; simpl; lia. Qed.
Lemma deep_le_length i s : deep i s <= length s.
Proof. induction s; simpl; [lia|]. destruct (i <=? a); lia. Qed.
Lemma deep_S i s : deep (S i) s <= deep i s.
Proof. induction s as [|a s IH]; cbn [deep]; [lia|].
  destruct (Nat.leb_spec (S i) a), (Nat.leb_spec i a); lia. Qed.
Lemma deep_mono i j s : deep (i + j) s <= deep i s.
Proof. induction j; [rewrite Nat.add_0_r; lia|].
  rewrite Nat.add_succ_r. pose proof (deep_S (i + j) s). lia. Qed.
Lemma deep_all i s : Forall (fun x => i <= x) s -> deep i s = length s.
Proof. induction 1 as [|x s Hx _ IH]; simpl; [lia|]. destruct (Nat.leb_spec i x); lia. Qed.
Lemma deep_none i s : Forall (fun x => x < i) s -> deep i s = 0.
Proof. induction 1 as [|x s Hx _ IH]; simpl; [lia|]. destruct (Nat.leb_spec i x); lia. Qed.

Lemma expand_length b b' : expand b b' -> length b' <= 2 * length b.
Proof. induction 1; cbn [length]; lia. Qed.
Lemma expand_lt b b' : expand b b' -> Forall (fun x => x < k) b'.
Proof. induction 1; [constructor|assumption|].
  constructor; [lia|constructor; [lia|assumption]]. Qed.
Lemma expand_ge i b b' : expand b b' -> Forall (fun x => i <= x) b -> Forall (fun x => S i <= x) b'.
Proof. induction 1; intro F; [constructor| |]; inversion F; subst; auto.
  constructor; [lia|constructor; [lia|auto]]. Qed.
Lemma expand_le m b b' : expand b b' -> Forall (fun x => x <= m) b -> Forall (fun x => x <= S m) b'.
Proof. induction 1; intro F; [constructor| |]; inversion F; subst; auto.
  constructor; [lia|constructor; [lia|auto]]. Qed.
Lemma expand_split_all b : expand b (split_all b).
Proof. induction b as [|l b IH]; [constructor|]. unfold split_all. cbn [flat_map].
  destruct (Nat.ltb_spec (S l) k); cbn [app].
  - apply expand_split; auto.
  - apply expand_drop; auto. Qed.
Lemma split_all_length b : Forall (fun x => S x < k) b -> length (split_all b) = 2 * length b.
Proof. induction 1 as [|l b Hl _ IH]; auto. unfold split_all in *. cbn [flat_map].
  rewrite app_length, IH. destruct (Nat.ltb_spec (S l) k); cbn [length]; lia. Qed.
Lemma split_all_most b : length (split_all b) <= 2 * length b.
Proof. apply expand_length, expand_split_all. Qed.
Lemma expand_le_split_all b b' : expand b b' -> length b' <= length (split_all b).
Proof. induction 1; unfold split_all in *; cbn [flat_map length]; rewrite ?app_length; [lia|lia|].
  destruct (Nat.ltb_spec (S l) k); cbn [length]; lia. Qed.

Lemma run_front s0 t s : run s0 (S t) s -> exists s1, step s0 s1 /\ run s1 t s.
Proof. revert s. induction t as [|t IH]; intros s R; inversion R; subst.
  - inversion H0; subst. exists s. split; auto. constructor.
  - destruct (IH _ H0) as (first & A & B). exists first. split; auto. econstructor; eauto. Qed.

(* ---- Lemma 1: the stack stays sorted, whatever the size of the batch ---- *)

Lemma sorted_app a b : sorted (a ++ b) <->
  sorted a /\ sorted b /\ (forall x y, In x a -> In y b -> y <= x).
Proof. induction a as [|h a IH]; simpl.
  - split; [intro; repeat split; auto; contradiction | tauto].
  - rewrite Forall_app, IH. repeat rewrite Forall_forall. split.
    + intros [[A B] [C [D F]]]. repeat split; auto. intros x y [->|Hx] Hy; auto.
    + intros [[A C] [D F]]. repeat split; auto. Qed.
Lemma expand_sorted b b' : expand b b' -> sorted b -> sorted b'.
Proof. induction 1 as [|l b b' E IH|l b b' Hl E IH]; simpl; auto; intros [A B]; auto.
  assert (Forall (fun x => x <= S l) b') by (eapply expand_le; eauto).
  repeat split; auto. Qed.
Lemma expand_above b b' : expand b b' ->
  forall y, (forall x, In x b -> y <= x) -> forall x, In x b' -> y <= x.
Proof. induction 1; intros y F x Hx; simpl in *; try contradiction; auto.
  destruct Hx as [<-|[<-|Hx]]; auto; specialize (F l (or_introl eq_refl)); lia. Qed.
Lemma stays_sorted b r b' : expand b b' -> sorted (b ++ r) -> sorted (b' ++ r).
Proof. intros E D. apply sorted_app in D. destruct D as (Db & Dr & X). apply sorted_app.
  repeat split; auto; [eapply expand_sorted; eauto|].
  intros x y Hx Hy. eapply expand_above; eauto. Qed.
Lemma sorted_repeat a n : sorted (repeat a n).
Proof. induction n; simpl; auto. split; auto. apply Forall_forall. intros x Hx.
  apply repeat_spec in Hx. lia. Qed.
Lemma levels_lt b r b' : expand b b' -> Forall (fun x => x < k) (b ++ r) ->
  Forall (fun x => x < k) (b' ++ r).
Proof. intros E F. apply Forall_app in F. apply Forall_app. split; [eapply expand_lt; eauto|tauto]. Qed.

(* ---- Lemma 2: every level holds at most p surfaces, or with all deeper ones at most 2p ---- *)

(* For a start on level a instead of 0, which Theorem 3 needs. *)
Definition layered a s := sorted s /\ Forall (fun x => a <= x) s /\
  forall i, a < i -> deep i s - deep (S i) s <= p \/ deep i s <= 2 * p.

(* Either the batch is full and within the levels from i on, or it takes all of them. *)
Lemma batch_cases i b r : sorted (b ++ r) -> length b = Nat.min p (length (b ++ r)) ->
  (Forall (fun x => i <= x) b /\ length b = p) \/ deep i r = 0.
Proof. intros D L. destruct (Nat.eq_dec (deep i r) 0) as [|Z]; auto. left.
  assert (exists y, In y r /\ i <= y) as (y & Hy & Hiy).
  { clear - Z. induction r as [|a r IH]; simpl in Z; [lia|].
    destruct (Nat.leb_spec i a); [exists a; simpl; auto|].
    destruct IH as (y & ? & ?); [lia|]. exists y; simpl; auto. }
  split.
  - apply sorted_app in D. destruct D as (_ & _ & X).
    apply Forall_forall. intros x Hx. specialize (X x y Hx Hy). lia.
  - rewrite app_length in L. destruct r; [contradiction|]. simpl in L. lia. Qed.

Lemma layered_step a s s' : layered a s -> step s s' -> layered a s'.
Proof. intros (D & A & I) St. destruct St as [b r b' L E].
  pose proof (stays_sorted _ _ _ E D) as D'.
  apply Forall_app in A. destruct A as [Ab Ar].
  split; [|split]; auto.
  - apply Forall_app. split; auto.
    eapply Forall_impl; [|exact (expand_ge a _ _ E Ab)]. simpl. lia.
  - intros i Hi. specialize (I i Hi). pose proof (expand_length _ _ E) as EL.
    destruct (batch_cases i b r D L) as [(F & Lp)|Z].
    + left. assert (F' := expand_ge i b b' E F).
      assert (G : Forall (fun x => i <= x) b')
        by (eapply Forall_impl; [|exact F']; simpl; intros; lia).
      rewrite !deep_app, (deep_all (S i) b' F'), (deep_all i b' G).
      rewrite !deep_app, (deep_all i b F) in *.
      pose proof (deep_S i r). pose proof (deep_le_length (S i) b).
      destruct I as [I|I]; lia.
    + right. rewrite deep_app, Z. pose proof (deep_le_length i b').
      rewrite app_length in L. lia. Qed.

Lemma layered_start a n : layered a (repeat a n).
Proof. repeat split.
  - apply sorted_repeat.
  - apply Forall_forall. intros x Hx. apply repeat_spec in Hx. lia.
  - intros i Hi. right. rewrite deep_none; [lia|]. apply Forall_forall. intros x Hx.
    apply repeat_spec in Hx. lia. Qed.
Lemma run_layered a n t s : run (repeat a n) t s -> layered a s.
Proof. induction 1; [apply layered_start | eapply layered_step; eauto]. Qed.

Lemma layers_sum a s : layered a s -> forall j i, a < i -> deep i s - deep (i + j) s <= p * (j + 1).
Proof. intros (_ & _ & I). induction j as [|j IH]; intros i Hi.
  - rewrite Nat.add_0_r. lia.
  - specialize (I i Hi). specialize (IH (S i) ltac:(lia)).
    replace (S i + j) with (i + S j) in IH by lia. pose proof (deep_S i s). nia. Qed.

(* ---- Theorem 3: at most m_l surfaces are of level l or shallower ---- *)

Lemma first_level_step a s s' : layered a s -> step s s' -> shallow a s' <= shallow a s.
Proof. intros (_ & A & _) St. destruct St as [b r b' L E]. unfold shallow. rewrite !app_length, !deep_app.
  apply Forall_app in A. destruct A as [Ab _].
  pose proof (deep_all _ _ (expand_ge a _ _ E Ab)).
  pose proof (deep_le_length (S a) b). pose proof (deep_le_length (S a) r). lia. Qed.
Lemma first_level a n t s : run (repeat a n) t s -> 1 <= t -> shallow a s <= n - p.
Proof. induction 1 as [|t s s' R IH St]; intro Ht; [lia|].
  destruct t.
  - inversion R; subst. pose proof (layered_start a n) as (_ & A & _).
    pose proof (repeat_length a n) as LN. destruct St as [b r b' L E]. unfold shallow.
    apply Forall_app in A. destruct A as [Ab _].
    pose proof (deep_all _ _ (expand_ge a _ _ E Ab)).
    rewrite app_length in *. rewrite deep_app. pose proof (deep_le_length (S a) r). lia.
  - pose proof (first_level_step _ _ _ (run_layered _ _ _ _ R) St). specialize (IH ltac:(lia)). lia. Qed.

Lemma most_front n d : most n (S d) = most (n + Nat.min p n) d.
Proof. induction d as [|d IH]; auto.
  change (most n (S (S d))) with (most n (S d) + Nat.min p (most n (S d))). rewrite IH. auto. Qed.
Lemma most_ge n d : n <= most n d.
Proof. induction d; cbn [most]; lia. Qed.
Lemma most_mono n n' d : n <= n' -> most n d <= most n' d.
Proof. intro H. induction d; cbn [most]; lia. Qed.
Lemma most_grows n i d : 1 <= n -> most n i + d <= most n (i + d).
Proof. intro H. assert (P : forall j, 1 <= most n j) by (induction j; cbn [most]; lia).
  induction d as [|d IH]; [rewrite (Nat.add_0_r i); lia|].
  rewrite (Nat.add_succ_r i). cbn [most]. specialize (P (i + d)). lia. Qed.
Lemma most_wide n d : p <= n -> most n d = n + p * d.
Proof. intro H. induction d; cbn [most]; nia. Qed.

Theorem levels_bound : forall d a n t s, run (repeat a n) t s -> shallow (a + d) s <= most n d.
Proof. induction d as [|d IH]; intros a n t s R; (destruct t as [|t];
    [inversion R; subst; unfold shallow; rewrite repeat_length; etransitivity;
     [apply Nat.le_sub_l|apply most_ge]|]).
  - rewrite Nat.add_0_r. cbn [most]. pose proof (first_level _ _ _ _ R ltac:(lia)). lia.
  - destruct (le_lt_dec p n) as [W|W].
    + rewrite most_wide by auto. pose proof (first_level _ _ _ _ R ltac:(lia)) as F.
      pose proof (layers_sum _ _ (run_layered _ _ _ _ R) (S d) (S a) ltac:(lia)) as G.
      unfold shallow in *. replace (S a + S d) with (S (a + S d)) in G by lia.
      pose proof (deep_mono (S a) (S d) s). pose proof (deep_le_length (S a) s).
      replace (S a + S d) with (S (a + S d)) in * by lia. nia.
    + apply run_front in R. destruct R as (s1 & St & R).
      assert (exists n', s1 = repeat (S a) n' /\ n' <= 2 * n) as (n' & -> & Hn).
      { clear R. remember (repeat a n) as s0 eqn:Q. destruct St as [b r b' L E].
        pose proof (repeat_length a n) as Ln. rewrite <- Q, app_length in Ln.
        rewrite app_length in L. assert (r = []) by (destruct r; auto; simpl in *; lia). subst r.
        rewrite !app_nil_r in *. exists (length b'). pose proof (expand_length _ _ E).
        split; [|simpl in *; lia].
        assert (G : Forall (fun x => x = S a) b').
        { clear - E Q. revert n Q. induction E as [|l b b' E IH|l b b' Hl E IH]; intros n Q; auto;
            destruct n; simpl in Q; try discriminate; injection Q as -> Q; eauto 6. }
        clear - G. induction G; simpl; congruence. }
      replace (a + S d) with (S a + d) by lia. rewrite most_front.
      etransitivity; [eapply IH; eauto|]. apply most_mono. lia. Qed.

(* ---- Corollary 4: the bound of the stack ---- *)

Definition start N := repeat 0 N.

Lemma run_lt N t s : run (start N) t s -> Forall (fun x => x < k) s.
Proof. induction 1 as [|t s s' R IH St].
  - apply Forall_forall. intros x Hx. apply repeat_spec in Hx. lia.
  - destruct St. eapply levels_lt; eauto. Qed.

(* What lies on the stack itself: no root does. *)
Definition stored (s : list nat) := deep 1 s.

Theorem stored_levels N t s l : run (start N) t s -> 1 <= l ->
  stored s - deep (S l) s <= most (Nat.min N p) l.
Proof. intros R Hl. unfold stored. destruct (le_lt_dec p N) as [W|W].
  - rewrite Nat.min_r, most_wide by lia.
    pose proof (layers_sum _ _ (run_layered _ _ _ _ R) l 1 ltac:(lia)) as G. simpl in G. nia.
  - rewrite Nat.min_l by lia. destruct t as [|t].
    + inversion R; subst. rewrite deep_none; [lia|].
      apply Forall_forall. intros x Hx. apply repeat_spec in Hx. lia.
    + pose proof (levels_bound l 0 N _ s R) as B. unfold shallow in B. simpl in B.
      pose proof (deep_le_length 1 s). lia. Qed.

Theorem stack_exact N t s : run (start N) t s -> 2 <= k -> stored s <= most (Nat.min N p) (k - 1).
Proof. intros R H. pose proof (stored_levels N t s (k - 1) R ltac:(lia)) as B.
  rewrite (deep_none (S (k - 1))) in B; [lia|].
  eapply Forall_impl; [|eapply run_lt; eauto]. simpl. lia. Qed.
Corollary stack_bound N t s : run (start N) t s -> stored s <= p * k.
Proof. intro R. pose proof (layers_sum _ _ (run_layered _ _ _ _ R) (k - 1) 1 ltac:(lia)) as G.
  rewrite (deep_none (1 + (k - 1))) in G; [unfold stored; nia|].
  eapply Forall_impl; [|eapply run_lt; eauto]. simpl. lia. Qed.
Corollary nothing_stored N t s : run (start N) t s -> k = 1 -> stored s = 0.
Proof. intros R H. apply deep_none. eapply Forall_impl; [|eapply run_lt; eauto]. simpl. lia. Qed.

(* The closed form; j is the number of iterations before the batch is full. *)
Lemma most_narrow n j : (forall i, i < j -> n * 2 ^ i <= p) -> most n j = n * 2 ^ j.
Proof. induction j as [|j IH]; intro H; cbn [most]; [simpl; lia|].
  rewrite IH by auto. specialize (H j ltac:(lia)). cbn [Nat.pow]. nia. Qed.
Theorem most_closed n j d : (forall i, i < j -> n * 2 ^ i <= p) -> p <= n * 2 ^ j ->
  most n (j + d) = n * 2 ^ j + p * d.
Proof. intros H W. rewrite <- (most_narrow n j H) in *. clear H.
  induction d as [|d IH]; [rewrite (Nat.add_0_r j); lia|].
  rewrite (Nat.add_succ_r j). cbn [most]. nia. Qed.

(* ---- Theorem 5: no order of the surfaces needs less ---- *)

(* Any surfaces may be taken, in any order, but p of them if there are as many. *)
Inductive any_run (N : nat) : nat -> list nat -> Prop :=
| any_0 : any_run N 0 (start N)
| any_S : forall t s b r, any_run N t s -> Permutation s (b ++ r) ->
    Nat.min p (length s) <= length b -> any_run N (S t) (split_all b ++ r).

Lemma deep_perm i a b : Permutation a b -> deep i a = deep i b.
Proof. induction 1; cbn [deep]; lia. Qed.
Lemma split_all_stored b : Forall (fun x => 1 <= x) (split_all b).
Proof. apply (expand_ge 0 b); [apply expand_split_all|]. apply Forall_forall. intros. lia. Qed.
Lemma deep_split_all b : Forall (fun x => S x < k) b -> deep 1 (split_all b) = 2 * length b.
Proof. intro F. rewrite <- (split_all_length b F). apply deep_all.
  apply split_all_stored. Qed.

Theorem any_order N t s : any_run N t s -> t < k ->
  Forall (fun x => x <= t) s /\ (t = 0 -> length s = N) /\ (1 <= t -> most (Nat.min N p) t <= stored s).
Proof. induction 1 as [|t s b r R IH P B]; intro H.
  - unfold start. repeat split; [|intro; apply repeat_length|lia].
    apply Forall_forall. intros x Hx. apply repeat_spec in Hx. lia.
  - destruct (IH ltac:(lia)) as (F & L & M). apply (Permutation_Forall P) in F.
    apply Forall_app in F. destruct F as [Fb Fr]. split; [|split; [lia|intros _]].
    + apply Forall_app. split.
      * exact (expand_le t _ _ (expand_split_all b) Fb).
      * eapply Forall_impl; [|exact Fr]. simpl. lia.
    + unfold stored in *. rewrite (deep_perm 1 _ _ P), deep_app in M. rewrite deep_app.
      rewrite deep_split_all by (eapply Forall_impl; [|exact Fb]; simpl; lia).
      pose proof (deep_le_length 1 b). pose proof (deep_le_length 1 s).
      rewrite (deep_perm 1 _ _ P), deep_app in *.
      cbn [most]. destruct t; [cbn [most]|]; lia. Qed.

(* ---- Corollary 6: the bound is reached ---- *)

Lemma both_runs N t : exists s, run (start N) t s /\ any_run N t s.
Proof. induction t as [|t (s & R & A)]; [exists (start N); split; constructor|].
  exists (split_all (firstn p s) ++ skipn p s). split.
  - econstructor; [exact R|]. rewrite <- (firstn_skipn p s) at 1. constructor.
    + rewrite firstn_skipn, firstn_length. auto.
    + apply expand_split_all.
  - econstructor; [exact A| |rewrite firstn_length; lia]. now rewrite firstn_skipn. Qed.
Theorem stack_exact_reached N : 2 <= k ->
  exists s, run (start N) (k - 1) s /\ stored s = most (Nat.min N p) (k - 1).
Proof. intro H. destruct (both_runs N (k - 1)) as (s & R & A). exists s. split; auto.
  pose proof (stack_exact _ _ _ R H). destruct (any_order _ _ _ A ltac:(lia)) as (_ & _ & B).
  specialize (B ltac:(lia)). lia. Qed.

(* ---- ADAPTIVE ---- *)

Variable C : nat. (* the capacity *)

(* index + k - level <= C, where the index counts from 0 at the bottom. *)
Fixpoint safe (s : list nat) : Prop :=
  match s with [] => True | l :: t => length t + k <= C + l /\ safe t end.

Lemma safe_app_r a b : safe (a ++ b) -> safe b.
Proof. induction a; simpl; tauto. Qed.

(* Lemma 7 *)
Lemma safe_fits s : safe s -> Forall (fun x => x < k) s -> length s <= C.
Proof. destruct s as [|l t]; cbn [safe length]; intros H F; [lia|]. inversion F; subst. lia. Qed.
Lemma safe_any b r b' : safe (split_all b ++ r) -> expand b b' -> safe (b' ++ r).
Proof. intros S E. induction E as [|l b b' E IH|l b b' Hl E IH]; auto.
  - apply IH. unfold split_all in *. cbn [flat_map] in S. rewrite <- app_assoc in S.
    eapply safe_app_r; eauto.
  - pose proof (expand_le_split_all _ _ E) as L. unfold split_all in *. cbn [flat_map] in S.
    destruct (Nat.ltb_spec (Datatypes.S l) k); [|lia].
    cbn [app safe length] in *. rewrite !app_length in *. destruct S as (A & B & D).
    repeat split; auto; lia. Qed.
Lemma safe_one l t : safe (l :: t) -> safe (split_all [l] ++ t).
Proof. unfold split_all. cbn [flat_map]. rewrite app_nil_r.
  destruct (Nat.ltb_spec (S l) k); cbn [app safe length]; intros (A & B); repeat split; auto; lia. Qed.

(* An iteration of ADAPTIVE takes any batch, not empty, of which all may be split; q roots only with all of the
   stack. *)
Inductive adaptive (N : nat) : nat -> nat -> list nat -> Prop :=
| adaptive_0 : adaptive N 0 N []
| adaptive_S : forall t w q b r b', adaptive N t (q + w) (b ++ r) -> q = 0 \/ r = [] ->
    b ++ repeat 0 q <> [] -> safe (split_all (b ++ repeat 0 q) ++ r) -> expand (b ++ repeat 0 q) b' ->
    adaptive N (S t) w (b' ++ r).

(* Surfaces that can still be processed. *)
Fixpoint weight (s : list nat) : nat :=
  match s with [] => 0 | l :: t => (2 ^ (k - l) - 1) + weight t end.
Lemma weight_app a b : weight (a ++ b) = weight a + weight b.
Proof. induction a; simpl; lia. Qed.
Lemma weight_expand b b' : expand b b' -> Forall (fun x => x < k) b ->
  weight b' + length b <= weight b.
Proof. induction 1 as [|l b b' E IH|l b b' Hl E IH]; intro F; auto;
    inversion F; subst; specialize (IH H2); cbn [weight length].
  - pose proof (Nat.pow_le_mono_r 2 1 (k - l) ltac:(lia) ltac:(lia)). simpl in *. lia.
  - replace (k - l) with (S (k - S l)) by lia. cbn [Nat.pow].
    pose proof (Nat.pow_le_mono_r 2 1 (k - S l) ltac:(lia) ltac:(lia)). simpl in *. lia. Qed.

Lemma weight_roots q : weight (repeat 0 q) = q * (2 ^ k - 1).
Proof. induction q; cbn [repeat weight]; [lia|]. rewrite IHq, Nat.sub_0_r. lia. Qed.

(* Theorem 8 *)
Lemma sorted_roots b q : sorted b -> sorted (b ++ repeat 0 q).
Proof. intro D. apply sorted_app. repeat split; [auto|apply sorted_repeat|].
  intros x y _ Hy. apply repeat_spec in Hy. lia. Qed.
Theorem adaptive_correct N t w s : adaptive N t w s ->
  sorted s /\ safe s /\ Forall (fun x => x < k) s /\ w * (2 ^ k - 1) + weight s + t <= N * (2 ^ k - 1).
Proof. induction 1 as [|t w q b r b' R (D & A & F & W) Z Hb Sa E].
  - repeat split; simpl; auto; lia.
  - assert (X : sorted (b ++ repeat 0 q ++ r)).
    { destruct Z as [->| ->]; [exact D|]. rewrite app_nil_r in *. now apply sorted_roots. }
    rewrite app_assoc in X. apply Forall_app in F. destruct F as [Fb Fr].
    assert (Y : Forall (fun x => x < k) (b ++ repeat 0 q)).
    { apply Forall_app. split; auto. apply Forall_forall. intros x Hx. apply repeat_spec in Hx. lia. }
    repeat split; [eapply stays_sorted; eauto|eapply safe_any; eauto| |].
    + apply Forall_app. split; [eapply expand_lt; eauto|auto].
    + pose proof (weight_expand _ _ E Y). rewrite !weight_app, weight_roots, Nat.mul_add_distr_r in *.
      destruct (b ++ repeat 0 q); [contradiction|]. cbn [length] in *. lia. Qed.
Corollary adaptive_fits N t w s : adaptive N t w s -> length s <= C.
Proof. intro R. destruct (adaptive_correct _ _ _ _ R) as (_ & S & F & _). now apply safe_fits. Qed.
Corollary adaptive_goes_on N t w s : k <= C -> adaptive N t w s -> s <> [] \/ 1 <= w ->
  exists w' s', adaptive N (S t) w' s'.
Proof. intros H R Hs. destruct (adaptive_correct _ _ _ _ R) as (_ & S & _ & _). destruct s as [|l r].
  - destruct w as [|w]; [destruct Hs; [contradiction|lia]|]. exists w. eexists.
    eapply (adaptive_S _ _ w 1 [] []); [exact R|auto|discriminate| |apply expand_split_all].
    cbn [repeat app]. apply (safe_one 0 []). cbn [safe length]. lia.
  - exists w. eexists. eapply (adaptive_S _ _ w 0 [l] r); [exact R|auto|discriminate| |apply expand_split_all].
    now apply safe_one. Qed.
Corollary adaptive_ends N t w s : adaptive N t w s -> t <= N * (2 ^ k - 1).
Proof. intro R. destruct (adaptive_correct _ _ _ _ R) as (_ & _ & _ & W).
  etransitivity; [apply Nat.le_add_l|exact W]. Qed.

(* Theorem 9: the largest batch. f of stack.md is 2 index + k - level - C, or 0 if that is negative. *)
Fixpoint need (b r : list nat) : nat :=
  match b with
  | [] => 0
  | l :: b' => Nat.max (if S l <? k then 2 * (length b' + length r) + k - l - C else 0) (need b' r)
  end.
Definition base (s : list nat) := Nat.max (length s - p) (need (firstn p s) (skipn p s)).

Lemma need_app a b r : need (a ++ b) r = Nat.max (need a (b ++ r)) (need b r).
Proof. induction a as [|l a IH]; cbn [app need]; [lia|]. rewrite IH, !app_length.
  replace (length a + length b + length r) with (length a + (length b + length r)) by lia. lia. Qed.
Lemma need_safe b r : safe (b ++ r) -> b <> [] -> need b r < length (b ++ r).
Proof. induction b as [|l b IH]; [contradiction|]. intros S _.
  cbn [app safe need length] in *. destruct S as (A & B). rewrite app_length in *.
  assert (need b r <= length b + length r).
  { destruct b; [simpl; lia|]. specialize (IH B ltac:(discriminate)). simpl in *. lia. }
  destruct (Nat.ltb_spec (S l) k); lia. Qed.
Lemma need_enough b r : safe r -> need b r <= length r -> safe (split_all b ++ r).
Proof. intros Sr. induction b as [|l b IH]; cbn [need]; intro H; auto.
  pose proof (split_all_most b) as L. unfold split_all in *. cbn [flat_map].
  destruct (Nat.ltb_spec (S l) k); cbn [app safe length]; rewrite ?app_length;
    repeat split; try apply IH; lia. Qed.
Lemma need_exact b r : sorted (b ++ r) -> safe r ->
  (safe (split_all b ++ r) <-> need b r <= length r).
Proof. intros D Sr. induction b as [|l b IH]; cbn [app sorted need] in *; [split; [lia|auto]|].
  destruct D as (F & D). specialize (IH D). unfold split_all in *. cbn [flat_map].
  destruct (Nat.ltb_spec (S l) k) as [H|H].
  - assert (L : length (split_all b) = 2 * length b).
    { apply split_all_length. apply Forall_app in F. destruct F as [F _].
      eapply Forall_impl; [|exact F]. simpl. lia. }
    unfold split_all in L. cbn [app safe length]. rewrite app_length, L. rewrite IH. lia.
  - cbn [app]. rewrite IH. lia. Qed.

(* What is needed below a batch is no more than what the stack has there: f(e) <= e. *)
Lemma need_above s c : safe s -> c <= p -> c <= length s ->
  (need (firstn p s) (skipn p s) <= length s - c <-> need (firstn c s) (skipn c s) <= length s - c).
Proof. intros S Hc Hs.
  pose proof (firstn_skipn c (firstn p s)) as W. rewrite firstn_firstn, Nat.min_l in W by lia.
  assert (T : skipn c (firstn p s) ++ skipn p s = skipn c s).
  { apply (app_inv_head (firstn c s)). rewrite app_assoc, W, !firstn_skipn. auto. }
  rewrite <- W at 1. rewrite need_app, T.
  assert (need (skipn c (firstn p s)) (skipn p s) <= length s - c); [|lia].
  pose proof (firstn_skipn c s) as X. rewrite <- X in S. apply safe_app_r in S. rewrite <- T in S.
  destruct (skipn c (firstn p s)) as [|h w] eqn:Y; [simpl; lia|].
  pose proof (need_safe _ _ S ltac:(discriminate)). rewrite T, skipn_length in H. lia. Qed.
Theorem base_exact s c : sorted s -> safe s -> c <= p -> c <= length s ->
  (safe (split_all (firstn c s) ++ skipn c s) <-> base s <= length s - c).
Proof. intros D S Hc Hs. pose proof (need_above s c S Hc Hs). unfold base. rewrite need_exact.
  - rewrite skipn_length. lia.
  - now rewrite firstn_skipn.
  - rewrite <- (firstn_skipn c s) in S. eapply safe_app_r; eauto. Qed.
Theorem base_takes s : safe s -> s <> [] -> base s < length s.
Proof. intros S H. unfold base. pose proof (firstn_skipn p s) as Q.
  assert (Y : firstn p s <> []) by (destruct s, p; [contradiction|contradiction|lia|discriminate]).
  rewrite <- Q in S. pose proof (need_safe _ _ S Y) as N. rewrite Q in N.
  destruct s; [contradiction|]. simpl length in *. lia. Qed.

(* Theorem 9 with roots: which numbers q of roots may be taken with all of the stack s. *)
Fixpoint roots_fit (q : nat) (s : list nat) : Prop :=
  match s with
  | [] => 1 < k -> 2 * (q - 1) + k <= C
  | l :: t => (S l < k -> 2 * (q + length t) + k <= C + l) /\ roots_fit q t
  end.
Lemma roots_need q s : 1 <= q -> (need (s ++ repeat 0 q) [] <= 0 <-> roots_fit q s).
Proof. intro Hq. induction s as [|l s IH]; cbn [app need roots_fit].
  - destruct q as [|q]; [lia|]. clear Hq. induction q as [|q IH].
    + cbn [repeat need length]. destruct (Nat.ltb_spec 1 k); lia.
    + change (repeat 0 (S (S q))) with (0 :: repeat 0 (S q)). cbn [need].
      rewrite repeat_length. cbn [length]. destruct (Nat.ltb_spec 1 k); lia.
  - rewrite app_length, repeat_length, Nat.max_lub_iff, IH. cbn [length].
    destruct (Nat.ltb_spec (S l) k); intuition lia. Qed.
Theorem roots_exact q s : sorted s -> 1 <= q ->
  (safe (split_all (s ++ repeat 0 q)) <-> roots_fit q s).
Proof. intros D Hq. rewrite <- roots_need, <- (app_nil_r (split_all _)) by auto.
  apply (need_exact _ []); simpl; auto. rewrite app_nil_r. now apply sorted_roots. Qed.
(* The same as the largest q, as the code has it; for the highest root e = l = 0, and q - 1 for q. *)
Lemma roots_below_exact q e l : 1 <= q -> l < k -> k <= C ->
  (2 * (q + e) + k <= C + l <-> q <= (C - (k - l)) / 2 - e).
Proof. intros. pose proof (Nat.div_mod (C - (k - l)) 2 ltac:(lia)).
  pose proof (Nat.mod_upper_bound (C - (k - l)) 2 ltac:(lia)). lia. Qed.
(* With a root in it no batch is allowed that its stack's entries do not allow. *)
Lemma roots_base q s : 1 <= q -> roots_fit q s -> length s <= p -> base s = 0.
Proof. intros Hq H L. apply roots_need in H; auto. rewrite need_app in H.
  unfold base. rewrite firstn_all2, skipn_all2 by auto.
  assert (G : forall b x, need b [] <= need b x); [|specialize (G s (repeat 0 q ++ [])); lia].
  clear. induction b as [|l b IH]; intro x; cbn [need length]; [lia|].
  specialize (IH x). destruct (S l <? k); lia. Qed.

(* Lemma 10: room for the whole batch b, seen at no level. *)
Lemma quick b r : length (b ++ r) + length b + k <= C + 2 -> need b r <= length r.
Proof. intro H. rewrite app_length in H.
  assert (G : forall a, length a <= length b -> need a r <= length r); [|auto].
  induction a as [|l a IH]; cbn [need length]; intro La; [lia|].
  specialize (IH ltac:(lia)). destruct (S l <? k); lia. Qed.

(* Theorem 11: with the capacity of BOUNDED no batch is shortened. v is what is stored, w roots wait. *)
Lemma stored_app v w i : deep (S i) (v ++ repeat 0 w) = deep (S i) v.
Proof. rewrite deep_app, (deep_none (S i) (repeat 0 w)); [lia|].
  apply Forall_forall. intros x Hx. apply repeat_spec in Hx. lia. Qed.
Lemma exact_safe N t v w : (2 <= k -> most (Nat.min N p) (k - 1) <= C) -> run (start N) t (v ++ repeat 0 w) ->
  Forall (fun x => 1 <= x) v -> safe v.
Proof. intros HC R V. pose proof (run_lt _ _ _ R) as K. apply Forall_app in K. destruct K as [K _].
  destruct (run_layered _ _ _ _ R) as (D & _). apply sorted_app in D. destruct D as (D & _).
  assert (B : forall l, 1 <= l -> deep 1 v - deep (S l) v <= most (Nat.min N p) l).
  { intros l Hl. pose proof (stored_levels _ _ _ l R Hl) as B. unfold stored in B.
    now rewrite !stored_app in B. }
  clear R. induction v as [|l v IH]; cbn [safe]; auto.
  cbn [sorted] in D. destruct D as (F & D). inversion K; inversion V; subst. split.
  - specialize (B l ltac:(auto)). cbn [deep] in B.
    destruct (Nat.leb_spec (S l) l), (Nat.leb_spec 1 l); try lia.
    rewrite (deep_all 1 v), (deep_none (S l)) in B by (auto; eapply Forall_impl, F; simpl; lia).
    assert (1 <= Nat.min N p).
    { destruct (Nat.min N p); [|lia]. assert (Z : forall j, most 0 j = 0)
        by (induction j; cbn [most]; lia). rewrite Z in B. lia. }
    pose proof (most_grows (Nat.min N p) l (k - 1 - l) ltac:(auto)) as G.
    replace (l + (k - 1 - l)) with (k - 1) in G by lia. specialize (HC ltac:(lia)). lia.
  - apply IH; auto. intros i Hi. specialize (B i Hi). cbn [deep] in B.
    destruct (Nat.leb_spec (S i) l), (Nat.leb_spec 1 l); lia. Qed.
Theorem full_width N t v w : (2 <= k -> most (Nat.min N p) (k - 1) <= C) -> run (start N) t (v ++ repeat 0 w) ->
  Forall (fun x => 1 <= x) v ->
  base v = length v - p /\ (1 <= Nat.min w (p - length v) -> roots_fit (Nat.min w (p - length v)) v).
Proof. intros HC R V.
  pose proof (exact_safe _ _ _ _ HC R V) as S.
  destruct (run_layered _ _ _ _ R) as (D & _). apply sorted_app in D. destruct D as (D & _).
  set (c := Nat.min p (length v)). set (q := Nat.min w (p - length v)).
  assert (S' : safe (split_all (firstn c v ++ repeat 0 q) ++ skipn c v)).
  { apply (exact_safe N (Datatypes.S t) _ (w - q) HC).
    - apply run_S with (s := v ++ repeat 0 w); [exact R|].
      replace (v ++ repeat 0 w) with
        ((firstn c v ++ repeat 0 q) ++ (skipn c v ++ repeat 0 (w - q))).
      + rewrite <- (app_assoc (split_all _)). constructor; [|apply expand_split_all].
        rewrite !app_length, firstn_length, skipn_length, !repeat_length. lia.
      + destruct (le_lt_dec p (length v)).
        * replace q with 0 by lia. cbn [repeat]. rewrite app_nil_r, Nat.sub_0_r, app_assoc, firstn_skipn. auto.
        * unfold c. rewrite Nat.min_r, firstn_all, skipn_all by lia. cbn [app].
          rewrite <- app_assoc, <- repeat_app. do 2 f_equal. lia.
    - apply Forall_app. split.
      + apply split_all_stored.
      + rewrite <- (firstn_skipn c v) in V. apply Forall_app in V. tauto. }
  destruct (Nat.eq_dec q 0) as [Z|Z].
  - rewrite Z in *. cbn [repeat] in S'. rewrite app_nil_r in S'. split; [|lia].
    apply base_exact in S'; auto; unfold base in *; lia.
  - assert (c = length v) as Hc by lia. rewrite Hc, firstn_all, skipn_all, app_nil_r in S'.
    apply roots_exact in S'; [|auto|lia]. split; [|auto].
    pose proof (roots_base q v ltac:(lia) S' ltac:(lia)). lia. Qed.

(* ---- LOCAL: many stacks, dealt anew ---- *)

(* Of entry j of stack g, where ns are the stacks' lengths: how many come before it, row by row. *)
Definition rank (ns : list nat) (g j : nat) :=
  list_sum (map (fun n => Nat.min n j) ns) + length (filter (fun n => j <? n) (firstn g ns)).

Definition lengths (ss : list (list nat)) := map (@length nat) ss.
Definition entry (s : list nat) (e : nat) := nth e (rev s) 0.

(* An entry of rank i comes to stack i mod G and lies there at i / G. *)
Definition dealt (ss ss' : list (list nat)) := length ss' = length ss /\
  forall g' e, g' < length ss -> e < length (nth g' ss' []) ->
    exists g j, g < length ss /\ j < length (nth g ss []) /\
      rank (lengths ss) g j = length ss * e + g' /\ entry (nth g' ss' []) e = entry (nth g ss []) j.

Lemma rank_row ns g j : list_sum (map (fun n => Nat.min n j) ns) <= length ns * j /\
  length (filter (fun n => j <? n) (firstn g ns)) <= g.
Proof. split.
  - induction ns; cbn [map list_sum fold_right length]; [lia|]. unfold list_sum in *. simpl. lia.
  - revert ns. induction g; intros [|n ns]; cbn [firstn filter length]; try lia.
    specialize (IHg ns). destruct (j <? n); cbn [length]; lia. Qed.

(* Lemma 12 *)
Theorem deal_lowers ns g j : g < length ns -> rank ns g j / length ns <= j.
Proof. intro H. destruct (rank_row ns g j). unfold rank.
  apply Nat.lt_succ_r, Nat.div_lt_upper_bound; nia. Qed.

Lemma row_S ns j : list_sum (map (fun n => Nat.min n (S j)) ns) =
  list_sum (map (fun n => Nat.min n j) ns) + length (filter (fun n => j <? n) ns).
Proof. induction ns as [|n ns IH]; auto. cbn [map filter]. unfold list_sum in *. cbn [fold_right].
  rewrite IH. destruct (Nat.ltb_spec j n); cbn [length]; lia. Qed.
Lemma row_mono ns j j' : j <= j' -> list_sum (map (fun n => Nat.min n j) ns) <=
  list_sum (map (fun n => Nat.min n j') ns).
Proof. intro H. unfold list_sum. induction ns; cbn [map fold_right]; lia. Qed.
Lemma column_S ns g g' j : g < g' -> g < length ns -> j < nth g ns 0 ->
  length (filter (fun n => j <? n) (firstn g ns)) < length (filter (fun n => j <? n) (firstn g' ns)).
Proof. revert g g'. induction ns as [|n ns IH]; intros g g' Hg Hl Hj; cbn [length] in Hl; [lia|].
  destruct g' as [|g']; [lia|]. destruct g as [|g]; cbn [firstn filter nth] in *.
  - destruct (Nat.ltb_spec j n); cbn [length]; lia.
  - specialize (IH g g' ltac:(lia) ltac:(lia) Hj). destruct (j <? n); cbn [length]; lia. Qed.
Lemma rank_mono ns g j g' j' : g < length ns -> j < nth g ns 0 -> j < j' \/ (j = j' /\ g < g') ->
  rank ns g j < rank ns g' j'.
Proof. intros Hg Hj [H|(<- & H)]; unfold rank.
  - pose proof (column_S ns g (length ns) j Hg Hg Hj). rewrite firstn_all in H0.
    pose proof (row_S ns j). pose proof (row_mono ns (S j) j' H). lia.
  - pose proof (column_S ns g g' j H Hg Hj). lia. Qed.
Lemma rank_total ns g j : g < length ns -> j < nth g ns 0 -> rank ns g j < list_sum ns.
Proof. intros Hg Hj. assert (B : forall j, list_sum (map (fun n => Nat.min n j) ns) <= list_sum ns)
    by (clear; intro j; unfold list_sum; induction ns; cbn [map fold_right]; lia).
  specialize (B (S j)). pose proof (row_S ns j).
  pose proof (column_S ns g (length ns) j Hg Hg Hj). rewrite firstn_all in H0. unfold rank. lia. Qed.

(* Every rank below the number of all surfaces belongs to exactly one. *)
Theorem deal_once ns g j g' j' : g < length ns -> j < nth g ns 0 -> g' < length ns -> j' < nth g' ns 0 ->
  rank ns g j = rank ns g' j' -> g = g' /\ j = j'.
Proof. intros. pose proof (rank_mono ns g j g' j'). pose proof (rank_mono ns g' j' g j). lia. Qed.
Theorem deal_all ns i : i < list_sum ns -> exists g j, g < length ns /\ j < nth g ns 0 /\ rank ns g j = i.
Proof. intro H.
  assert (R : forall m, i < list_sum (map (fun n => Nat.min n m) ns) -> exists j,
    list_sum (map (fun n => Nat.min n j) ns) <= i < list_sum (map (fun n => Nat.min n (S j)) ns)).
  { induction m as [|m IH]; intro Hm.
    - exfalso. revert Hm. clear. unfold list_sum. induction ns; cbn [map fold_right]; [lia|].
      rewrite Nat.min_0_r. auto.
    - destruct (le_lt_dec (list_sum (map (fun n => Nat.min n m) ns)) i); eauto. }
  assert (T : forall m, list_sum ns <= m -> list_sum (map (fun n => Nat.min n m) ns) = list_sum ns).
  { clear. unfold list_sum. induction ns as [|n ns IH]; intro m; cbn [map fold_right]; [lia|].
    intro Hm. rewrite IH; lia. }
  destruct (R (list_sum ns)) as (j & A & B); [now rewrite T|]. rewrite row_S in B.
  assert (Q : forall r ms, r < length (filter (fun n => j <? n) ms) -> exists g, g < length ms /\
    j < nth g ms 0 /\ length (filter (fun n => j <? n) (firstn g ms)) = r).
  { clear. intros r ms. revert r. induction ms as [|n ms IH]; intros r Hr; cbn [filter length] in Hr; [lia|].
    destruct (Nat.ltb_spec j n) as [L|L]; cbn [length] in Hr; [destruct r as [|r]|].
    - exists 0. simpl. repeat split; auto; lia.
    - destruct (IH r ltac:(lia)) as (g & X & Y & Z). exists (S g).
      cbn [length nth firstn filter]. destruct (Nat.ltb_spec j n); cbn [length]; repeat split; auto; lia.
    - destruct (IH r Hr) as (g & X & Y & Z). exists (S g).
      cbn [length nth firstn filter]. destruct (Nat.ltb_spec j n); cbn [length]; repeat split; auto; lia. }
  destruct (Q (i - list_sum (map (fun n => Nat.min n j) ns)) ns ltac:(lia)) as (g & X & Y & Z).
  exists g, j. unfold rank. repeat split; auto. lia. Qed.

Lemma safe_entries s : safe s <-> forall e, e < length s -> e + k <= C + entry s e.
Proof. unfold entry. induction s as [|l s IH]; cbn [safe length rev]; [split; [lia|auto]|]. split.
  - intros (A & B) e He. destruct (Nat.eq_dec e (length s)) as [->|].
    + rewrite app_nth2, rev_length, Nat.sub_diag by (rewrite rev_length; lia). exact A.
    + rewrite app_nth1 by (rewrite rev_length; lia). apply IH; auto. lia.
  - intro H. split.
    + specialize (H (length s) ltac:(lia)).
      rewrite app_nth2, rev_length, Nat.sub_diag in H by (rewrite rev_length; lia). exact H.
    + apply IH. intros e He. specialize (H e ltac:(lia)).
      rewrite app_nth1 in H by (rewrite rev_length; lia). exact H. Qed.
Lemma dealt_from ss ss' s' e : dealt ss ss' -> In s' ss' -> e < length s' ->
  exists s j, In s ss /\ e <= j < length s /\ entry s' e = entry s j.
Proof. intros (L & D) Hs He. apply (In_nth _ _ []) in Hs. destruct Hs as (g' & Hg' & <-).
  rewrite L in Hg'. destruct (D g' e Hg' He) as (g & j & Hg & Hj & Q & ->).
  exists (nth g ss []), j. repeat split; auto; [now apply nth_In|].
  pose proof (deal_lowers (lengths ss) g j) as B. unfold lengths in *. rewrite map_length in B.
  specialize (B Hg). now rewrite Q, Nat.mul_comm, Nat.div_add_l, Nat.div_small, Nat.add_0_r in B by lia. Qed.
Lemma deal_safe ss ss' : Forall safe ss -> dealt ss ss' -> Forall safe ss'.
Proof. intros F D. apply Forall_forall. intros s' Hs. apply safe_entries. intros e He.
  destruct (dealt_from _ _ _ _ D Hs He) as (s & j & I & B & ->). rewrite Forall_forall in F.
  pose proof (proj1 (safe_entries s) (F s I) j ltac:(lia)). lia. Qed.
Lemma deal_levels ss ss' : Forall (Forall (fun x => x < k)) ss -> dealt ss ss' ->
  Forall (Forall (fun x => x < k)) ss'.
Proof. intros F D. apply Forall_forall. intros s' Hs. apply Forall_forall. intros l Hl.
  apply in_rev in Hl. apply (In_nth _ _ 0) in Hl. destruct Hl as (e & He & <-). rewrite rev_length in He.
  destruct (dealt_from _ _ _ _ D Hs He) as (s & j & I & B & Q). unfold entry in Q. rewrite Q.
  rewrite Forall_forall in F. apply (proj1 (Forall_forall _ _) (F s I)), (proj2 (in_rev _ _)), nth_In.
  rewrite rev_length. lia. Qed.

(* Lemma 13: q roots may go below the surfaces s, all of level m and deeper. *)
Definition may_give (q m : nat) (s : list nat) := Forall (fun x => m <= x) s /\ q + k <= C + 1 /\
  (s <> [] -> q + length s + k <= C + 1 + m).
Lemma give_safe q m s : may_give q m s -> safe (s ++ repeat 0 q).
Proof. intros (F & Q & H). induction F as [|l s Hl F IH].
  - clear H. cbn [app]. induction q; cbn [repeat safe]; auto. rewrite repeat_length. split; [lia|apply IHq; lia].
  - specialize (H ltac:(discriminate)). cbn [app safe length] in *. rewrite app_length, repeat_length.
    split; [lia|]. apply IH. intros _. lia. Qed.

(* Theorem 14. Stacks need not be sorted any more. *)
Inductive local (N G : nat) : nat -> list (list nat) -> Prop :=
| local_start : local N G N (repeat [] G)
| local_batch : forall w x y b r b', local N G w (x ++ (b ++ r) :: y) -> b <> [] ->
    need b r <= length r -> expand b b' -> local N G w (x ++ (b' ++ r) :: y)
| local_deal : forall w ss ss', local N G w ss -> dealt ss ss' -> local N G w ss'
| local_give : forall w q m x y s, local N G (q + w) (x ++ s :: y) -> may_give q m s ->
    local N G w (x ++ (s ++ repeat 0 q) :: y).

Lemma local_correct N G w ss : local N G w ss -> Forall safe ss /\ Forall (Forall (fun x => x < k)) ss.
Proof. induction 1 as [|w x y b r b' R (A & F) Hb H E|w ss ss' R (A & F) D|w q m x y s R (A & F) M].
  - split; apply Forall_forall; intros s Hs; apply repeat_spec in Hs; subst; simpl; auto.
  - apply Forall_app in A. apply Forall_app in F. destruct A as (Ax & A), F as (Fx & F).
    inversion A; inversion F; subst. split; apply Forall_app; split; auto; constructor; auto.
    + eapply safe_any; [|exact E]. apply need_enough; auto. eapply safe_app_r; eauto.
    + eapply levels_lt; eauto.
  - split; [eapply deal_safe|eapply deal_levels]; eauto.
  - apply Forall_app in A. apply Forall_app in F. destruct A as (Ax & A), F as (Fx & F).
    inversion A; inversion F; subst. split; apply Forall_app; split; auto; constructor; auto.
    + eapply give_safe; eauto.
    + apply Forall_app. split; auto. apply Forall_forall. intros l Hl. apply repeat_spec in Hl. lia. Qed.
Theorem local_fits N G w ss : local N G w ss -> Forall (fun s => length s <= C) ss.
Proof. intro R. destruct (local_correct _ _ _ _ R) as (A & F). apply Forall_forall. intros s Hs.
  rewrite Forall_forall in A, F. apply safe_fits; auto. Qed.
Theorem local_takes N G w ss s : local N G w ss -> In s ss -> s <> [] ->
  let c := length s - base s in 1 <= c /\ need (firstn c s) (skipn c s) <= length (skipn c s).
Proof. intros R Hs H c. destruct (local_correct _ _ _ _ R) as (A & _). rewrite Forall_forall in A.
  specialize (A s Hs). pose proof (base_takes s A H). rewrite skipn_length.
  pose proof (need_above s c A). unfold c, base in *. split; [lia|]. apply H1; lia. Qed.
Theorem local_gives : k <= C -> may_give 1 0 [].
Proof. intro H. repeat split; auto; [lia|congruence]. Qed.
End Stack.

(* Theorem 5 for batches of one and more: below k entries nothing works. *)
Corollary capacity_needed N k s : 1 <= N -> 2 <= k -> any_run 1 k N (k - 1) s -> k <= stored s.
Proof. intros H K R. assert (K' : 1 <= k) by lia.
  destruct (any_order 1 k (le_n 1) K' N _ s R ltac:(lia)) as (_ & _ & B). specialize (B ltac:(lia)).
  rewrite (Nat.min_r N 1 H), (most_wide 1 k (le_n 1) K' 1 (k - 1) (le_n 1)) in B. lia. Qed.

Print Assumptions stack_exact.
Print Assumptions stack_bound.
Print Assumptions nothing_stored.
Print Assumptions most_closed.
Print Assumptions stack_exact_reached.
Print Assumptions capacity_needed.
Print Assumptions adaptive_fits.
Print Assumptions adaptive_goes_on.
Print Assumptions adaptive_ends.
Print Assumptions base_exact.
Print Assumptions base_takes.
Print Assumptions roots_exact.
Print Assumptions roots_below_exact.
Print Assumptions roots_base.
Print Assumptions quick.
Print Assumptions full_width.
Print Assumptions deal_lowers.
Print Assumptions deal_once.
Print Assumptions deal_all.
Print Assumptions local_fits.
Print Assumptions local_takes.
Print Assumptions local_gives.
